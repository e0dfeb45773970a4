// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stopping of fragments (physics.md 2). After lattice.glsl.
#ifndef __cplusplus
uniform float sleep_distance_m;  // distance from its rest position at which a free node is stopped
#endif

/// Stops falling fragments at sleep_distance_m; they may come back. A displacement of more than a tenth of it in a substep is not
/// a fall but an explosion, which is left to the stability monitor.
void fallAsleep(NodeBits bits, vec3 u, INOUT(vec3) u_next, INOUT(vec3) v_next) {
  float away = dot(u_next, u_next);
  // Written so that NaN is not stopped either, for the stability monitor to find.
  if (!(away > sleep_distance_m * sleep_distance_m && away > dot(u, u)) || (bits.lo & kGrabMask) != 0u) return;
  vec3 leap = u_next - u;
  if (dot(leap, leap) > 0.01f * sleep_distance_m * sleep_distance_m) return;
  u_next = u;
  v_next = vec3(0.0f);
}
