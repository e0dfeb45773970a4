// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_begin.comp - start of a substep of implicit Euler: increments of prescribed nodes, and y for the others.
// Owner: solver/gpu/implicit_substep.h   physics.md 2
// in  displacement, velocity [slots]     out  increments [slots]     Feature: TOOLS
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#ifdef TOOLS
#include "contact.glsl"
#endif

#ifndef __cplusplus
layout(std430, binding = kBindIncrement) writeonly buffer IncrementBuffer { vec4 increments[]; };
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  increments[slot] = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  if (isAtRest(bits)) return;
#ifdef TOOLS
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) {
    increments[slot] = vec4(heldDisplacement(held_by - 1u, slot) - xyz(texelFetch(displacement, int(slot))), 1.0f);
    return;
  }
#endif
  increments[slot] = vec4(freeIncrement(slot, bodies[bodyOf(bits)]), 0.0f);
}
