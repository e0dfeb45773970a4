// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_meet.comp - sums each node's contacts.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// out  contacts [slots]     Feature AHEAD: also reserves room for the pairs of each node
#include "solver/collision/collision_search.glsl"
#ifdef AHEAD
#include "solver/implicit/implicit_pairs.glsl"
#endif

vec3 direction_sum = vec3(0.0f);
float contact_count = 0.0f;

void visit(Entry me, Entry other, float wanted) {
  bool first = me.slot < other.slot;
  vec3 direction = first ? directionBetween(me, other) : -directionBetween(other, me);
  direction_sum += (wanted - distance(me.x, other.x)) * direction;
  contact_count += 1.0f;
}
bool isAlone(uint slot) { return false; }
void begin() {
  direction_sum = vec3(0.0f);
  contact_count = 0.0f;
}
void end(uint slot) {
  contacts[slot] = vec4(direction_sum, contact_count);
#ifdef AHEAD
  reservePairs(slot, uint(contact_count));
#endif
}

#include "solver/collision/collision_visit.glsl"
