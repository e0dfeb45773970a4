// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Poses of an obstacle at the start and at the end of a tick, tissue frame.
struct RigidMotion {
  Pose from, to;
};
using ObstacleMotions = std::vector<RigidMotion>;  ///< [obstacles] of the scene

}  // namespace viscera
