// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parameters of a substep for every integrator, and the nodes that do not take part (physics.md 2, 5). After elastic.glsl.
#include "solver/tissue/sleep.glsl"
#ifndef __cplusplus
#ifndef AWAKE
uniform uint active_count;
#endif
uniform float dt_s;              // drift: time step of u
uniform float kick_s;            // leapfrog's kick: half the previous substep plus half of this one; half of dt_s in the first
uniform vec3 gravity;            // m/s2

#ifdef TOOLS
uniform uint slot_count;
uniform float push_speed;        // m/s: largest speed at which a probe pushes a node out
#endif
#endif

/// Fixed, or isolated and not held: an isolated node sleeps, as it would fall endlessly.
bool isAtRest(NodeBits bits) {
  return (bits.lo & kFixedBit) != 0u || (isIsolated(bits) && (bits.lo & kGrabMask) == 0u);
}
