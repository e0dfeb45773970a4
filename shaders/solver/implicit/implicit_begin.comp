// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_begin.comp - start of a substep of implicit Euler: increments of prescribed nodes, and y for the others.
// Owner: solver/device/implicit_substep.h   physics.md 2
// in  displacement, velocity [slots]     out  increments [slots]     Features: CONTACT, TOOLS, OBSTACLES
#undef LOADS  // the buffer that it writes must not be read through another binding
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#ifdef CONTACT
#include "solver/implicit/implicit_contact.glsl"
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
    increments[slot] = vec4(heldDisplacement(held_by - 1u, slot) - xyz(stateAt(displacement, int(slot))), 1.0f);
    return;
  }
#endif
  vec3 y = freeIncrement(slot, bodies[bodyOf(bits)]);
#ifdef CONTACT
  clearContacts(slot);
  findContacts(slot, xyz(stateAt(displacement, int(slot))), y);
  if (contactCount(slot) != 0u) {
    increments[slot] = vec4(outside(slot, y), -1.0f);
    return;
  }
#endif
  increments[slot] = vec4(y, 0.0f);
}
