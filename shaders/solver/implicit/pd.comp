// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// pd.comp - one sweep of PD-Jacobi in majorise-minimise form, accelerated by Chebyshev's recurrence.   Owner: solver/device/pd.h
// physics.md 2: x <- (m'/dt^2 y + sum k (x_far + l0 n)) / (m'/dt^2 + sum k), here as du += force / (m'/dt^2 + sum (k + c/dt))
// in  displacement, velocity, increments     out  next increments, in place of those of the iterate before the last
// Feature RATE computes the rates that bound the spectrum of the iteration instead.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#include "solver/implicit/implicit_pull.glsl"
#ifdef CONTACT
#include "solver/implicit/implicit_contact.glsl"
#endif

#ifdef RATE
/// Writes the maxima over nodes of (sum of k)/m [1/s2] and of (sum of k dashpot_s)/m [1/s] to the guard, as float bits.
void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  if ((bits.lo & kFixedBit) != 0u) return;
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body), stiffness = 0.0f;
#define VISIT_LINK stiffness += k;
  FOR_EACH_LINK
#undef VISIT_LINK
  atomicMax(guard[0], floatBitsToUint(stiffness / mass));  // positive floats order like their bits
  atomicMax(guard[1], floatBitsToUint(stiffness * body.dashpot_s / mass));
}
#else
#ifndef __cplusplus
layout(std430, binding = kBindIncrementOut) buffer IncrementOut { vec4 next_increments[]; };  // holds the iterate before the last
uniform uint iteration;
uniform float omega;  // Chebyshev's weight; 1 is plain Jacobi
#endif

/// Returns whether the last sweep moved a node farther than the first did, by more than the ratio of the norms. Modes within the
/// spectrum cannot grow (in the sum of squares; the maximum over nodes may for a while), so acceleration has excited one outside.
bool wentWrong() {
  const float allowed = 4.0f;
  if (iteration == 0u) return false;
  return !(uintBitsToFloat(guard[changeWord(iteration - 1u)]) <= allowed * uintBitsToFloat(guard[changeWord(0u)]));
}
bool wasPlain() { return iteration > 0u && guard[plainWord(iteration - 1u)] != 0u; }

void recordChange(vec3 change) {
  uint bits = floatBitsToUint(length(change));
  // The read before the atomic only saves work: the maximum is the same.
  if (bits > guard[changeWord(iteration)]) atomicMax(guard[changeWord(iteration)], bits);
}

vec4 restarted(uint slot, vec3 du) {
#ifdef CONTACT
  if (contactCount(slot) != 0u) return vec4(outside(slot, du), -1.0f);
#endif
  return vec4(du, 0.0f);
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  bool was_plain = wasPlain(), plain = was_plain || (omega != 1.0f && wentWrong());
  if (i == 0u && plain) {
    guard[plainWord(iteration)] = 1u;
    if (!was_plain) guard[changeWord(iteration)] = uint(guard[changeWord(0u)]);  // this iteration changes nothing
  }
  vec4 now = stateAt(increment, int(slot));
  if (isPrescribed(now) || isInPairs(now)) {  // the latter move together (implicit_pull.comp)
    next_increments[slot] = now;
    return;
  }
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  if (plain && !was_plain) {  // restart after diverged acceleration
    next_increments[slot] = restarted(slot, uintBitsToFloat(guard[0]) * freeIncrement(slot, body));
    return;
  }
  vec3 u = xyz(stateAt(displacement, int(slot)));
  vec4 p = pull(slot, bits, body, u, xyz(now));
  vec3 change = xyz(p) / p.w;
#ifdef CONTACT
  findContacts(slot, u, xyz(now) + change);
  bool in_contact = contactCount(slot) != 0u;
  if (in_contact) change = stepInContact(slot, p.w, xyz(now), xyz(p));
#endif
  recordChange(change);
  vec3 next = xyz(now) + change;
  if (omega != 1.0f && !plain) {
    vec3 before = xyz(next_increments[slot]);
    next = before + omega * (next - before);
  }
#ifdef CONTACT
  findContacts(slot, u, next);  // contacts with what the accelerated step would end in
  in_contact = contactCount(slot) != 0u;
  next_increments[slot] = in_contact ? vec4(outside(slot, next), -1.0f) : vec4(next, 0.0f);
#else
  next_increments[slot] = vec4(next, 0.0f);
#endif
}
#endif
