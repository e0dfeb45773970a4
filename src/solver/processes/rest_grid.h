// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

#include "viscera/math/types.h"

namespace viscera {

/// A regular grid of nodes in the tissue frame at rest.
struct RestGrid {
  double spacing_m = 1;
  Vector3d origin_m = Vector3d::Zero();  ///< position of node (0, 0, 0)
  Vector3i count = Vector3i::Zero();     ///< nodes per axis

  size_t positions() const {
    return static_cast<size_t>(count.x()) * static_cast<size_t>(count.y()) * static_cast<size_t>(count.z());
  }
  size_t at(const Vector3i& node) const {
    const auto row = static_cast<size_t>(count.x()), layer = row * static_cast<size_t>(count.y());
    return static_cast<size_t>(node.x()) + row * static_cast<size_t>(node.y()) + layer * static_cast<size_t>(node.z());
  }
  bool has(const Vector3i& node) const { return (node.array() >= 0).all() && (node.array() < count.array()).all(); }
  Vector3i nearest(const Vector3d& at_m) const {
    const Vector3d middle = (at_m - origin_m) / spacing_m;
    return {static_cast<int>(std::lround(middle.x())), static_cast<int>(std::lround(middle.y())),
            static_cast<int>(std::lround(middle.z()))};
  }
};

}  // namespace viscera
