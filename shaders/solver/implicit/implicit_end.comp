// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_end.comp - end of a substep of implicit Euler: state = displacement + increment; momentum of tools and obstacles,
// sleep.
// Owner: solver/device/implicit_substep.h   physics.md 2
// in  displacement, velocity, increments [slots]     out  displacement, velocity [slots]     Features: CONTACT, TOOLS, OBSTACLES, PAIRS
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#ifdef CONTACT
#include "solver/implicit/implicit_contact.glsl"
#endif
#ifdef PAIRS
#include "solver/implicit/implicit_pairs.glsl"
#endif

#ifndef __cplusplus
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#endif

/// Returns the force of contacts with other nodes on a node [N].
vec3 forceOfPairs(uint slot) {
#ifdef PAIRS
  if (pairsOf(slot).count != 0u) return xyz(node_pairs[3u * slot + 2u]);
#endif
  return vec3(0.0f);
}

#ifdef PAIRS
/// Returns the inverse mass [1/kg] times the number of active contacts; 0 for prescribed nodes.
float splitMobility(uint slot) {
  if (node_pairs[3u * slot].w == 0.0f) return 0.0f;
  NodeBits bits = nodes[slot];
  return max(1.0f, node_pairs[3u * slot + 2u].w) / nodeMass(slot, bits, bodies[bodyOf(bits)]);
}

/// Returns the change of velocity by bouncing off other nodes [m/s], as off an obstacle (bounceOf()).
vec3 bounceOffPairs(uint slot) {
  PairRun run = pairsOf(slot);
  vec3 sum = vec3(0.0f);
  if (pair_restitution == 0.0f) return sum;
  for (uint end = run.first; end < run.first + run.count; ++end) {
    if (xyz(pair_rows[2u * end + 1u]) == vec3(0.0f)) continue;
    uint other = pair_words[otherWord(end)], a = min(slot, other), b = max(slot, other);
    vec3 normal = xyz(pair_rows[2u * end]);
    float came = dot(xyz(stateAt(velocity, int(b))) - xyz(stateAt(velocity, int(a))), normal);
    float give = splitMobility(a) + splitMobility(b);
    if (came <= pair_bounces_from || give == 0.0f) continue;
    float leaves = dot(xyz(stateAt(increment, int(a))) - xyz(stateAt(increment, int(b))), normal) / dt_s;
    sum += ((slot == a ? 1.0f : -1.0f) * max(0.0f, pair_restitution * came - leaves) / give) * normal;
  }
  NodeBits bits = nodes[slot];
  return sum / nodeMass(slot, bits, bodies[bodyOf(bits)]);
}
#endif

#ifdef CONTACT
/// Returns the residual of a node's lattice and inertia forces [N]: the force of the tool or obstacle that holds or touches it.
vec3 forceFromOutside(uint slot, NodeBits bits, float mass, BodyParams body, vec3 u, vec3 du) {
  vec3 force = inertia(mass, body) * (du - freeIncrement(slot, body)) - forceOfPairs(slot);
#define VISIT_LINK force -= implicitSpring(n, u, du, d, l0, prestrain, k, body).force;
  FOR_EACH_LINK
#undef VISIT_LINK
  return force;
}

/// Distributes the residual of the last sweep to the active contacts, along their normals.
void balanceContacts(uint slot, vec3 force) {
  const uint rounds = 4u;
  uint count = contactCount(slot);
  vec3 left = force;
  for (uint row = 0u; row < count; ++row) left -= contactOf(slot, row).force;
  for (uint i = 0u; i < rounds * count; ++i) {
    Contact c = contactOf(slot, i % count);
    float pressure = dot(c.force, c.normal);
    if (pressure <= 0.0f) continue;
    vec3 change = max(dot(left, c.normal), -pressure) * c.normal;
    left -= change;
    node_contacts[contactAt(slot, i % count) + 2u] = vec4(c.force + change, c.owner);
  }
}
#endif
#include "solver/implicit/implicit_give.glsl"

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = xyz(stateAt(displacement, int(slot)));
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(0.0f);
    return;
  }
  vec4 increased = stateAt(increment, int(slot));
  vec3 du = xyz(increased);
  vec3 u_next = u + du, v_next = du / dt_s;
#ifdef PAIRS
  if (isInPairs(increased)) v_next += bounceOffPairs(slot);
  else if (most_pairs != 0u && !isPrescribed(increased)) node_pairs[3u * slot + 2u] = vec4(0.0f);  // for the guess of the next substep
#endif
#ifdef CONTACT
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  if (isInContact(increased)) {
    balanceContacts(slot, forceFromOutside(slot, bits, mass, body, u, du));
    giveContacts(slot, mass, v_next);
  }
#endif
#ifdef TOOLS
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) giveMomentum(held_by - 1u, slot, dt_s * forceFromOutside(slot, bits, mass, body, u, du));
  else feel(slot, restPosition(slot) + u_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
