// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_scale.comp - scales the increments by the share that implicit_fold.comp chose. One share is 0, so P is at most P(0)
// afterwards, whatever the increments were.   Owner: solver/device/implicit_substep.h   physics.md 2
// in, out  increments [slots]
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
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec4 du = increments[slot];
  if (isPrescribed(du)) return;
  vec3 scaled = xyz(du) * uintBitsToFloat(guard[0]);
#ifdef CONTACT
  if (isInContact(du)) scaled = outside(slot, scaled);
#endif
  increments[slot] = vec4(scaled, du.w);
}
