// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/layout/obstacle_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// One substep, as passed to every integrator on every backend (physics.md 2).
struct Substep {
  float dt_s = 0;
  float kick_s = 0;  ///< leapfrog: half the previous substep plus half of this one; half of dt_s in the very first [s]
  Vector3f gravity = Vector3f::Zero();  ///< [m/s2]
  float sleep_distance_m = 1;
  float push_speed_m_per_s = 0;  ///< largest speed at which a probe pushes nodes out [m/s]
  float edge_reach_m = 0;        ///< edgeReach() [m]
  bool tools = false;            ///< a probe or held nodes may act: the kernel with tools is used
  bool restarted = false;        ///< the state was written from outside since the last substep
  int index = 0;                 ///< index among the tick's substeps
  float most_step = 0;           ///< slowing.h, in a recovery: largest displacement of a node, over its body's spacing
  bool implicit = false;         ///< implicit Euler: external effects are part of the solution
  const layout::ObstacleMotion* obstacles = nullptr;  ///< [kMaxObstacles], of which obstacle_count exist
  uint32_t obstacle_count = 0;
  float resting_speed_m_per_s = 0;  ///< slower impacts on an obstacle or another node do not bounce [m/s]
};

}  // namespace viscera
