// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_push.comp - sums what each node's contacts do to it.
// Owner: solver/gpu/collision_pass.h   physics.md 8
// in  contacts     out  corrections [2 * slots]
#include "collision_search.glsl"

vec3 impulse_sum = vec3(0.0f), shift_sum = vec3(0.0f);

void visit(Entry me, Entry other, float wanted) {
  if (me.slot < other.slot) {
    Push push = pushBetween(me, other, wanted);
    impulse_sum += push.impulse;
    shift_sum += push.shift;
  } else {
    Push push = pushBetween(other, me, wanted);
    impulse_sum -= push.impulse;
    shift_sum -= push.shift;
  }
}
bool isAlone(uint slot) { return contacts[slot].w == 0.0f; }  // collision_meet.comp has found nobody: no need to search again
void begin() { impulse_sum = shift_sum = vec3(0.0f); }
void end(uint slot) {
  // A held node is not moved; the tool that holds it against this feels it (surroundings.comp).
  corrections[2u * slot] = vec4(inverseMassWithout(slot, kFixedBit) * impulse_sum, 0.0f);
  corrections[2u * slot + 1u] = vec4(inverseMass(slot) * shift_sum, 0.0f);
}

#include "collision_visit.glsl"
