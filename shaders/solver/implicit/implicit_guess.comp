// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_guess.comp - per node, for four shares of the increments at once: the incremental potential P, and kinetic + elastic
// energy less the work of gravity.   Owner: solver/device/implicit_substep.h   physics.md 2
// in  displacement, velocity, increments [slots]     out  energies [2 * active], summed by implicit_fold.comp
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
#include "solver/tissue/shares.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindPartials) writeonly buffer PartialsBuffer { vec4 energies[]; };
#endif

/// Returns the share of an increment. Nodes in contact stay outside the obstacle or probe at any share.
vec3 share(uint slot, vec4 du, int c) {
  if (isPrescribed(du)) return xyz(du);
#ifdef CONTACT
  if (isInContact(du)) return outside(slot, kShares[c] * xyz(du));
#endif
  return kShares[c] * xyz(du);
}


/// Adds a spring's elastic energy, and its dashpot's term of P, for the four shares.
/// @param a, b  its ends   @param near, far  their increments   @param w  u_far - u_near   @param d, l0, prestrain  at rest
void addSpring(uint a, uint b, vec4 near, vec4 far, vec3 w, vec3 d, float l0, float prestrain, float k, float damping, INOUT(vec4) elastic,
               INOUT(vec4) damped) {
  for (int c = 0; c < 4; ++c) {
    vec3 along = share(b, far, c) - share(a, near, c);
    Spring s = springBetween(d, l0, prestrain, w + along);
    float rate = dot(s.direction, along);
    elastic[c] += 0.5f * k * s.extension * s.extension;
    damped[c] += 0.5f * damping * rate * rate;
  }
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  vec4 du = stateAt(increment, int(slot));
  vec3 u = xyz(stateAt(displacement, int(slot)));
  vec4 elastic = vec4(0.0f), potential = vec4(0.0f), motion = vec4(0.0f);
  if (!isPrescribed(du)) {
    vec3 y = freeIncrement(slot, body), v = xyz(stateAt(velocity, int(slot)));
    for (int c = 0; c < 4; ++c) {
      vec3 offset = share(slot, du, c), off = offset - y;
      potential[c] = 0.5f * inertia(mass, body) * dot(off, off);
      motion[c] = 0.5f * mass * dot(offset, offset) / (dt_s * dt_s) - mass * dot(gravity, offset);
    }
#ifdef CONTACT
    // Energy before the substep plus what moving surfaces may add: at share 0 nodes in contact are where the surfaces put them.
    vec3 put = share(slot, du, 0);
    float brought = 0.5f * mass * dot(put, put) / (dt_s * dt_s);
    if (isInContact(du)) {
      for (int c = 0; c < 4; ++c) potential[c] += frictionOf(slot, share(slot, du, c));
      brought += frictionOf(slot, put);
    }
    motion[0] = 0.5f * mass * dot(v, v) + brought;
#else
    motion[0] = 0.5f * mass * dot(v, v);
#endif
#ifdef PAIRS
    // Work of contacts with other nodes, with their last forces: so resting nodes do not fall, and nodes without contact move on.
    if (isInPairs(du)) {
      for (int c = 0; c < 4; ++c) potential[c] -= dot(xyz(node_pairs[3u * slot + 2u]), share(slot, du, c));
    }
#endif
  }
#define VISIT_LINK                                                                                              \
  if (counted) addSpring(slot, n, du, stateAt(increment, int(n)), xyz(stateAt(displacement, int(n))) - u, d, l0,     \
                         prestrain, k, damping(k, body), elastic, potential);
  FOR_EACH_LINK
#undef VISIT_LINK
  energies[ENERGIES_PER_NODE * i] = potential + elastic;
  energies[ENERGIES_PER_NODE * i + 1u] = motion + elastic;
}
