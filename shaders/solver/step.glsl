// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every integrator is told of a substep, and which nodes do not take part (physics.md 2, 5). After elastic.glsl.
#ifndef __cplusplus
uniform uint active_count;
uniform float dt_s;              // drift: how long u moves on
uniform float kick_s;            // leapfrog's kick: half the substep before, half this one; half in the first
uniform vec3 gravity;            // m/s2
uniform float sleep_distance_m;  // a free node is stopped this far from its rest place

#ifdef TOOLS
uniform uint slot_count;
uniform float push_speed;        // m/s: a probe pushes a node out no faster
#endif
#endif

/// Fixed, or alone and not held: a lone node sleeps; it would fall for ever.
bool isAtRest(NodeBits bits) {
  return (bits.lo & kFixedBit) != 0u || (isIsolated(bits) && (bits.lo & kGrabMask) == 0u);
}

/// Fragments that fall come to lie where sleep_distance_m ends; they may come back. One that would leap a tenth of it in a
/// substep does not fall, it explodes: that is left for the governor to see.
void fallAsleep(NodeBits bits, vec3 u, INOUT(vec3) u_next, INOUT(vec3) v_next) {
  float away = dot(u_next, u_next);
  // Written so that a number that is not one is left alone too, for the governor to find.
  if (!(away > sleep_distance_m * sleep_distance_m && away > dot(u, u)) || (bits.lo & kGrabMask) != 0u) return;
  vec3 leap = u_next - u;
  if (dot(leap, leap) > 0.01f * sleep_distance_m * sleep_distance_m) return;
  u_next = u;
  v_next = vec3(0.0f);
}
