// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_push.comp - sums the effects of each node's contacts on it.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in  contacts     out  corrections [2 * slots]
#include "solver/collision/collision_search.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindVelocityOut) readonly buffer VelocityOut { vec4 next_velocity[]; };  // before the substep
#endif

/// Effect of a contact on the node of the lower slot, a [N s] and [kg m].
struct Push {
  vec3 impulse;
  vec3 shift;  // times the inverse mass: its displacement
};

Push pushOf(vec3 impulse, vec3 shift) {
  Push push = {impulse, shift};
  return push;
}

/// Jacobi by mass splitting: a node with n contacts enters each with 1/n of its mass. So the contacts together neither overshoot
/// nor add energy, and momentum is conserved.
Push pushBetween(Entry a, Entry b, float wanted) {
  float inverse_a = inverseMass(a.slot), inverse_b = inverseMass(b.slot);
  vec4 sum_a = contacts[a.slot], sum_b = contacts[b.slot];
  float inverse = sum_a.w * inverse_a + sum_b.w * inverse_b;
  if (inverse == 0.0f) return pushOf(vec3(0.0f), vec3(0.0f));
  vec3 normal = contactNormal(directionBetween(a, b), sum_a, sum_b);
  const float relaxation = 0.25f;  // share of the depth that is removed per substep
  // Depth before the substep: the depth added in the substep is removed with the approach.
  float depth = max(0.0f, wanted - distance(a.before, b.before));
  vec3 shift = (min(relaxation * depth, push_speed * dt_s) / inverse) * normal;
  vec3 v = xyz(stateAt(velocity, int(a.slot))) - xyz(stateAt(velocity, int(b.slot)));
  float approach = dot(v, normal);
  if (approach >= 0.0f) return pushOf(vec3(0.0f), shift);
  // The speed before the substep bounces: including that from forces in it, a body pressed against another would gain energy.
  float came = dot(xyz(next_velocity[b.slot]) - xyz(next_velocity[a.slot]), normal);
  float change = -approach + (came > resting_speed ? restitution * came : 0.0f);
  vec3 sliding = v - approach * normal;
  float speed = length(sliding);
  vec3 impulse = (change / inverse) * normal;
  if (speed > 0.0f) impulse -= (min(friction * change, speed) / (inverse * speed)) * sliding;
  return pushOf(impulse, shift);
}

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
bool isAlone(uint slot) { return contacts[slot].w == 0.0f; }  // collision_meet.comp has found none: no search needed
void begin() { impulse_sum = shift_sum = vec3(0.0f); }
void end(uint slot) {
  // A held node does not move; the tool that holds it receives the force (environment.comp).
  corrections[2u * slot] = vec4(inverseMassWithout(slot, kFixedBit) * impulse_sum, 0.0f);
  corrections[2u * slot + 1u] = vec4(inverseMass(slot) * shift_sum, 0.0f);
}

#include "solver/collision/collision_visit.glsl"
