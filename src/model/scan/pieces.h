// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// A mask: a byte a voxel, i fastest.
struct Mask {
  Vector3i size = Vector3i::Zero();
  std::vector<uint8_t> voxels;

  size_t at(int i, int j, int k) const {
    return static_cast<size_t>(i) +
           static_cast<size_t>(size.x()) *
               (static_cast<size_t>(j) + static_cast<size_t>(size.y()) * static_cast<size_t>(k));
  }
};

/// The pieces of a mask's voxels of one value, joined by faces. In memory: runs of two slices, and 12 bytes for each
/// place where one begins that touches none before it.
class Pieces {
 public:
  Pieces(const Mask& mask, uint8_t value);
  /// [piece] voxels of it; 0 of what became part of another
  const std::vector<uint64_t>& voxels() const { return voxels_; }
  size_t count() const;
  /// Whether a piece has a voxel at the mask's border.
  bool atBorder(uint32_t piece) const { return at_border_[piece] != 0; }
  /// Gives the voxels of pieces another value. The mask must be the one that was given.
  void assign(Mask& mask, const std::function<bool(uint32_t piece)>& which, uint8_t value) const;

 private:
  uint8_t value_;
  std::vector<uint32_t> root_;  ///< [piece] the one that it became part of, or itself
  std::vector<uint64_t> voxels_;
  std::vector<uint8_t> at_border_;
};

/// All within a distance of voxels of `value` gets it. Distances are along axes taken for perpendicular.
void grow(Mask& mask, uint8_t value, const Vector3d& spacing, double distance);

}  // namespace viscera
