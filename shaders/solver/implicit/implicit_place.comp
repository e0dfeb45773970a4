// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_place.comp - increments of nodes that may touch others, under the current forces of their contacts.
// Owner: solver/device/implicit_substep.h   physics.md 2
// in  increments [slots], pairs (implicit_pairs.glsl)     out  pairs; at the end of a sweep increments
// Features: CONTACT, TOOLS, OBSTACLES
#undef LOADS  // the buffer that it writes must not be read through another binding
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#include "solver/implicit/implicit_pull.glsl"
#include "solver/implicit/implicit_pairs.glsl"
#ifdef CONTACT
#include "solver/implicit/implicit_contact.glsl"
#endif
#include "solver/implicit/implicit_place.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };
uniform uint ends_sweep;
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec4 now = increments[slot];
  if (!isInPairs(now)) return;
  place(slot, node_pairs[3u * slot], xyz(stateAt(displacement, int(slot))), xyz(now));
  if (ends_sweep != 0u) increments[slot] = vec4(xyz(node_pairs[3u * slot + 1u]), kInPairs);
}
