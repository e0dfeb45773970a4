// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of a node with an obstacle, and the effect of wind on it (physics.md 8). After lattice.glsl.
#include "solver/tools/touch.glsl"

#ifndef __cplusplus
uniform uint active_count;
uniform float dt_s;
uniform float push_speed;     // m/s: largest speed at which nodes deep in an obstacle leave it
uniform float resting_speed;  // m/s: slower impacts do not bounce
#endif

/// Moves a node out of an obstacle. Its approach is reversed by the restitution, and friction reduces its sliding by at most
/// Coulomb's share of the change. Friction acts on the displacement of the substep too, or a resting node would creep.
/// @return whether they touch
bool meetObstacle(ObstacleMotion o, vec3 x, INOUT(vec3) x_next, INOUT(vec3) v_next) {
  Meeting meeting = meetingOf(o, x, x_next);
  if (!meeting.touches) return false;
  vec3 normal = meeting.normal, out_of = meeting.out_of;
  // The displacement of this substep is undone at once; a node inside an obstacle that appeared leaves no faster than a probe
  // pushes.
  float offset = length(out_of), most = max(push_speed * dt_s, 1.001f * meeting.offset);
  x_next += (offset > most ? most / offset : 1.0f) * out_of;
  vec3 v = v_next - (xyz(o.velocity) + cross(xyz(o.spin), x_next - xyz(o.to)));
  float approach = dot(v, normal);
  if (approach >= 0.0f) return true;
  float change = -approach * (-approach > resting_speed ? 1.0f + o.spin.w : 1.0f);
  vec3 sliding = v - approach * normal;
  float speed = length(sliding);
  vec3 friction = speed > 0.0f ? -(min(o.velocity.w * change, speed) / speed) * sliding : vec3(0.0f);
  v_next += change * normal + friction;
  x_next += dt_s * friction;
  return true;
}

/// Returns the change of a node's velocity by wind [m/s]: pressure rho C/2 |w_n| w_n on its area, with w_n the normal component
/// of the air's velocity relative to the node. A substep at most removes that component.
/// @param area  normal times area [m2]   @param air  velocity [m/s]; w rho C/2 [kg/m3]
vec3 windKick(vec3 area, vec4 air, vec3 v, float mass) {
  float size = length(area);
  if (size == 0.0f) return vec3(0.0f);
  vec3 normal = area / size;
  float across = dot(xyz(air) - v, normal);
  return (min(air.w * abs(across) * size * dt_s / mass, 1.0f) * across) * normal;
}
