// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Poses of obstacles over a substep.
#ifndef VISCERA_LAYOUT_OBSTACLE_MOTION_H
#define VISCERA_LAYOUT_OBSTACLE_MOTION_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// Rigid obstacle over one substep, tissue frame.
struct ObstacleMotion {
  vec4 from;  // xyz position of the origin at the start [m]; w radius [m]
  vec4 to;  // xyz position of the origin at the end [m]; w half length of a capsule [m]
  vec4 from_orientation;  // quaternion xyzw
  vec4 to_orientation;
  vec4 velocity;  // xyz velocity of the origin [m/s]; w friction coefficient
  vec4 spin;  // xyz angular velocity [rad/s]; w coefficient of restitution
  vec4 half_size;  // xyz half edges of a box [m]
  uvec4 info;  // x shape: one of the constants below
};
const uint kShapePlane = 0u;
const uint kShapeSphere = 1u;
const uint kShapeCapsule = 2u;
const uint kShapeBox = 3u;
const uint kMostContacts = 3u;  // contacts that a node can have with probes and obstacles at once, in implicit integrators

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
