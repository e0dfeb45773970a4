// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// Returns a clamp of all nodes on the negative side of a plane.
inline FixedConfig clampBehind(const Vector3d& point_m, const Vector3d& normal) {
  FixedConfig clamp;
  clamp.shape = FixedShape::kPlane;
  clamp.point_m = point_m;
  clamp.normal = normal;
  return clamp;
}

/// Returns a clamp of all nodes above a height.
inline FixedConfig clampAbove(double height_m) {
  return clampBehind({0, 0, height_m}, -Vector3d::UnitZ());
}

}  // namespace viscera::bench
