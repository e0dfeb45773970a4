// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/layout/limits.h"
#include "viscera/math/types.h"

namespace viscera {

/// A needle after a tick. Its wire lies about the y axis of its own frame, on a circle of radius_m about the origin:
/// the tip is at (radius_m, 0, 0) and heads for +z, the tail is arc_rad behind it.
struct SeenNeedle {
  size_t thread = 0;  ///< of the scene, which begins at its tail
  Pose pose;          ///< of its own frame, tissue frame
  double radius_m = 0, arc_rad = 0, wire_radius_m = 0;
  size_t stylus = layout::kMaxStyluses;  ///< that holds it; kMaxStyluses: none
  bool in_tissue = false;                ///< some of it is
};

}  // namespace viscera
