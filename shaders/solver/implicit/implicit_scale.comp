// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_scale.comp - increments = the share of them that implicit_fold.comp chose. One share is 0, so P is P(0) or below from
// there on, whatever the increments were.   Owner: solver/device/implicit_substep.h   physics.md 2
// in, out  increments [slots]
#undef LOADS  // what it writes must not be read by another name
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
