// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Needle after a tick. In its own frame the wire is an arc about the y axis with radius_m around the origin. The tip
/// is at (radius_m, 0, 0) and points along +z; the tail is arc_rad behind it.
struct NeedleState {
  size_t suture = 0;  ///< index of the suture in the scene, which begins at its tail
  Pose pose;          ///< pose of its own frame, tissue frame
  double radius_m = 0, arc_rad = 0, wire_radius_m = 0;
  size_t stylus = layout::kMaxStyluses;  ///< index of the stylus that holds it; kMaxStyluses: none
  bool in_tissue = false;                ///< some of it is in tissue
};

}  // namespace viscera
