// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Where obstacles are in a substep.
#ifndef VISCERA_LAYOUT_OBSTACLE_MOTION_H
#define VISCERA_LAYOUT_OBSTACLE_MOTION_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A rigid obstacle over one substep, tissue frame.
struct ObstacleMotion {
  vec4 from;              // xyz origin at the start [m]; w radius [m]
  vec4 to;                // xyz origin at the end [m]; w half length of a capsule [m]
  vec4 from_orientation;  // quaternion xyzw
  vec4 to_orientation;
  vec4 velocity;          // xyz of its origin [m/s]; w friction
  vec4 spin;              // xyz angular velocity [rad/s]; w restitution
  vec4 half_size;         // xyz box: half edges [m]
  uvec4 info;             // x shape
};
const uint kShapePlane = 0u;
const uint kShapeSphere = 1u;
const uint kShapeCapsule = 2u;
const uint kShapeBox = 3u;
const uint kMostContacts = 3u;  // of a node with probes and obstacles at once, in implicit integrators

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
