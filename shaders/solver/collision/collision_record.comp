// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_record.comp - records the contacts that nodes may have in an implicit substep.   physics.md 2, 8
// Owner: solver/gpu/contact/collision_pass.h
// in  contacts [slots] of collision_meet.comp     out  pairs (implicit_pairs.glsl); marks nodes with pairs in the increments
#undef LOADS  // the buffer that it writes must not be read through another binding
#include "solver/collision/collision_search.glsl"
#include "solver/implicit/implicit_pairs.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };
#endif

uint recorded = 0u;

void visit(Entry me, Entry other, float wanted) {
  PairRun run = pairsOf(me.slot);
  if (recorded >= run.count) return;
  uint end = run.first + recorded++;
  bool first = me.slot < other.slot;
  vec3 normal = first ? contactNormal(directionBetween(me, other), contacts[me.slot], contacts[other.slot])
                      : contactNormal(directionBetween(other, me), contacts[other.slot], contacts[me.slot]);
  float apart = first ? distance(me.before, other.before) : distance(other.before, me.before);
  pair_words[otherWord(end)] = other.slot;
  pair_rows[2u * end] = vec4(normal, max(0.0f, apart - wanted / widened));
  pair_rows[2u * end + 1u] = vec4(0.0f);
}
bool isAlone(uint slot) { return contacts[slot].w == 0.0f; }
void begin() { recorded = 0u; }
void end(uint slot) {
  uint count = pairsOf(slot).count;
  if (count == 0u) return;
  vec4 du = increments[slot];
  node_pairs[3u * slot] = vec4(0.0f);
  node_pairs[3u * slot + 1u] = vec4(xyz(du), float(count));
  if (du.w <= 0.0f) increments[slot] = vec4(xyz(du), kInPairs);
}

#include "solver/collision/collision_visit.glsl"
