// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/body/skin.h"

namespace viscera {

/// How deep places of one body lie below its skin at rest: measured once at its nodes, so that a wall asks no more than
/// the eight around it.
class WoundDepths {
 public:
  /// @param skin, lattice  of one body; the lattice must outlive this
  WoundDepths(const Skin& skin, const Lattice& lattice);
  /// @param point  in cells from the lattice's origin   @returns [m], 0 at the skin and outside
  double at(const Vector3d& point) const;

 private:
  const Lattice& lattice_;
  std::vector<float> depth_m_;  ///< [slots], less than 0 outside
};

}  // namespace viscera
