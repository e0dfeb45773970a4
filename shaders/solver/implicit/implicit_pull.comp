// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_pull.comp - forces on nodes that may touch others, and their increments under these and the last forces of their
// contacts.
// Owner: solver/device/implicit_substep.h   physics.md 2
// in  displacement, velocity, increments [slots], cell forces of this iterate     out  pairs (implicit_pairs.glsl)
// Features: CONTACT, TOOLS, OBSTACLES
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
uniform uint first_sweep;  // 1: contacts have no forces yet
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec4 now = stateAt(increment, int(slot));
  if (!isInPairs(now)) return;
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec3 u = xyz(stateAt(displacement, int(slot))), du = xyz(now);
  vec4 pulled = pull(slot, bits, body, u, du);
  node_pairs[3u * slot] = pulled;
  if (first_sweep != 0u) node_pairs[3u * slot + 2u] = vec4(0.0f, 0.0f, 0.0f, node_pairs[3u * slot + 1u].w);
  place(slot, pulled, u, du);
}
