// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every integrator is told of a substep, and which nodes do not take part (physics.md 2, 5). After elastic.glsl.
#include "solver/tissue/sleep.glsl"
#ifndef __cplusplus
#ifndef AWAKE
uniform uint active_count;
#endif
uniform float dt_s;              // drift: how long u moves on
uniform float kick_s;            // leapfrog's kick: half the substep before, half this one; half in the first
uniform vec3 gravity;            // m/s2

#ifdef TOOLS
uniform uint slot_count;
uniform float push_speed;        // m/s: a probe pushes a node out no faster
#endif
#endif

/// Fixed, or alone and not held: a lone node sleeps; it would fall for ever.
bool isAtRest(NodeBits bits) {
  return (bits.lo & kFixedBit) != 0u || (isIsolated(bits) && (bits.lo & kGrabMask) == 0u);
}
