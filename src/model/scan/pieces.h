// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Mask with a byte per voxel, i fastest.
struct Mask {
  Vector3i size = Vector3i::Zero();
  std::vector<uint8_t> voxels;

  size_t at(int i, int j, int k) const {
    return static_cast<size_t>(i) +
           static_cast<size_t>(size.x()) *
               (static_cast<size_t>(j) + static_cast<size_t>(size.y()) * static_cast<size_t>(k));
  }
};

/// Pieces of a mask's voxels of one value, joined by faces. In memory: runs of two slices, and 12 bytes for each run
/// that touches no earlier one.
class Pieces {
 public:
  Pieces(const Mask& mask, uint8_t value);
  /// Returns the number of voxels [piece]; 0 for a piece that was merged into another.
  const std::vector<uint64_t>& voxels() const { return voxels_; }
  size_t count() const;
  /// Returns whether a piece has a voxel at the mask's border.
  bool atBorder(uint32_t piece) const { return at_border_[piece] != 0; }
  /// Sets the voxels of some pieces to another value. The mask must be that of the constructor.
  void assign(Mask& mask, const std::function<bool(uint32_t piece)>& which, uint8_t value) const;

 private:
  uint8_t value_;
  std::vector<uint32_t> root_;  ///< [piece] piece that it was merged into, or itself
  std::vector<uint64_t> voxels_;
  std::vector<uint8_t> at_border_;
};

/// Sets all voxels within a distance of voxels of `value` to it. Distances assume perpendicular axes.
void grow(Mask& mask, uint8_t value, const Vector3d& spacing, double distance);

}  // namespace viscera
