// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_pairs.comp - lists contacts, for tests.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// out  pairs
#include "solver/collision/collision_search.glsl"

#ifndef __cplusplus
uniform uint most_pairs;
layout(std430, binding = kBindPairs) buffer PairsBuffer { uint pairs[]; };  // number of pairs, then two slots each
void addPair(uint a, uint b) {
  uint position = atomicAdd(pairs[0], 1u);
  if (position >= most_pairs) return;
  pairs[1u + 2u * position] = a;
  pairs[2u + 2u * position] = b;
}
#endif
void visit(Entry me, Entry other, float wanted) {
  if (me.slot < other.slot) addPair(me.slot, other.slot);
}
bool isAlone(uint slot) { return false; }
void begin() {}
void end(uint slot) {}

#include "solver/collision/collision_visit.glsl"
