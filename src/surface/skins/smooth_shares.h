// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/body/lattice.h"

namespace viscera {

/// Shares of the nodes of one lattice (NodePaint), smoothed so that the paint of a single node is round and a line of
/// nodes has straight borders. Where all nodes around have one share, it stays.
class SmoothShares {
 public:
  /// @param shares  [slots of the lattice]
  SmoothShares(const Lattice& lattice, const float* shares);
  /// Returns the share at a place at rest [m, tissue frame]; 0 away from painted nodes.
  float at(const Vector3f& rest_m) const;

 private:
  size_t indexOf(const Vector3i& node) const;
  void blur(int axis, std::vector<float>& sums, std::vector<float>& weights) const;

  Vector3d origin_m_;
  double spacing_m_;
  Vector3i low_ = Vector3i::Zero(), size_ = Vector3i::Zero();  ///< box of nodes around the painted ones
  std::vector<float> smooth_;                                  ///< [nodes of the box] x fastest
};

}  // namespace viscera
