// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/body/skin.h"

namespace viscera {

/// Depth of places of one body below its surface at rest. Measured once at its nodes, so that a wall only interpolates
/// between eight nodes.
class WoundDepths {
 public:
  /// @param skin, lattice  of one body; the lattice must outlive this
  WoundDepths(const Skin& skin, const Lattice& lattice);
  /// Returns the depth [m], 0 at the surface and outside. @param point  in cells from the lattice's origin
  double at(const Vector3d& point) const;

 private:
  const Lattice& lattice_;
  std::vector<float> depth_m_;  ///< [slots], below 0 outside
};

}  // namespace viscera
