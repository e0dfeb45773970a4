// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where fragments come to lie (physics.md 2). After lattice.glsl.
#ifndef __cplusplus
uniform float sleep_distance_m;  // a free node is stopped this far from its rest place
#endif

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
