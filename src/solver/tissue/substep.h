// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/layout/obstacle_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// One substep, as every integrator on every backend is told of it (physics.md 2).
struct Substep {
  float dt_s = 0;
  float kick_s = 0;  ///< leapfrog: half the substep before and half this one; half of dt_s in the very first
  Vector3f gravity = Vector3f::Zero();  ///< [m/s2]
  float sleep_distance_m = 1;
  float push_speed_m_per_s = 0;  ///< largest speed at which a probe pushes nodes out
  float edge_reach_m = 0;        ///< edgeReach()
  bool tools = false;            ///< probe or held nodes are about: the kernel that knows them is used
  bool restarted = false;        ///< the state was written from outside since the last substep
  int index = 0;                 ///< of the tick's substeps
  float most_way = 0;            ///< slowing.h, in a recovery: that a node goes at most, over its body's spacing
  bool implicit = false;         ///< implicit Euler: what comes from outside is part of the solution
  const layout::ObstacleMotion* obstacles = nullptr;  ///< [kMaxObstacles], of which obstacle_count are there
  uint32_t obstacle_count = 0;
  float resting_speed_m_per_s = 0;  ///< what comes slower at an obstacle or another node does not bounce
};

}  // namespace viscera
