// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit.comp - start and end of a substep of implicit Euler.   Owner: solver/gpu/implicit_substep.h   physics.md 2
// One of these features:
//   BEGIN  increments of prescribed nodes, and y for the others
//   GUESS  per node, for four shares of the increments at once: the incremental potential P and kinetic + elastic energy less the
//          work of gravity; FOLD sums them and chooses a share
//   SCALE  increments = that share of them. One share is 0, so P is P(0) or below from there on, whatever the increments were
//   CELLS  forces and majorisers of the cells in the current iterate, as volume.comp has them
//   END    state = displacement + increment; momentum of tools, sleep
#include "layout.h"
#include "lattice.glsl"

const vec4 kShares = vec4(0.0f, 0.5f, 0.75f, 1.0f);
const float kRounding = 1e-6f;  // of sums of energies: differences below it say nothing

/// Two vectors per node: P per share [J]; energy before the substep, then after it with shares 1, 2, 3 [J].
#define ENERGIES_PER_NODE 2u

#ifdef FOLD
#ifndef __cplusplus
const uint kRun = 64u;
layout(std430, binding = kBindPartials) buffer PartialsBuffer { vec4 energies[]; };
layout(std430, binding = kBindGuard) buffer GuardBuffer { uint guard[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint input_first;
layout(location = 2) uniform uint output_first;
layout(location = 3) uniform uint last_level;
layout(location = 4) uniform uint bound_energy;  // 1: a share that ends with more energy than there was is not taken
#endif

bool atMost(float a, float b) { return a <= b + kRounding * abs(b); }

/// The largest share that no smaller one betters. What is not finite is not at most anything, and 0 is always there.
int bestShare(vec4 potential, vec4 energy) {
  int best = 3;
  for (int c = 2; c >= 0; --c) {
    bool gains = bound_energy != 0u && !atMost(energy[best], energy[0]);
    if (gains || !atMost(potential[best], potential[c])) best = c;
  }
  return best;
}

#ifndef __cplusplus  // there the sums are in float64
void main() {
  uint run = globalIndex();
  if (run * kRun >= count) return;
  vec4 potential = vec4(0.0f), energy = vec4(0.0f);
  uint end = min((run + 1u) * kRun, count);
  for (uint i = run * kRun; i < end; ++i) {
    potential += energies[ENERGIES_PER_NODE * (input_first + i)];
    energy += energies[ENERGIES_PER_NODE * (input_first + i) + 1u];
  }
  energies[ENERGIES_PER_NODE * (output_first + run)] = potential;
  energies[ENERGIES_PER_NODE * (output_first + run) + 1u] = energy;
  if (last_level != 0u) guard[0] = floatBitsToUint(kShares[bestShare(potential, energy)]);
}
#endif
#else
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#ifdef TOOLS
#include "contact.glsl"
#endif

uint cornerSlot(uint slot, uint c) { return neighborSlot(slot, ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u)); }

#ifdef BEGIN
#ifndef __cplusplus
layout(std430, binding = kBindIncrement) writeonly buffer IncrementBuffer { vec4 increments[]; };
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  increments[slot] = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  if (isAtRest(bits)) return;
#ifdef TOOLS
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) {
    increments[slot] = vec4(heldDisplacement(held_by - 1u, slot) - xyz(texelFetch(displacement, int(slot))), 1.0f);
    return;
  }
#endif
  increments[slot] = vec4(freeIncrement(slot, bodies[bodyOf(bits)]), 0.0f);
}
#endif

#ifdef GUESS
#ifndef __cplusplus
layout(std430, binding = kBindPartials) writeonly buffer PartialsBuffer { vec4 energies[]; };
#endif

vec3 share(vec4 du, int c) { return du.w != 0.0f ? xyz(du) : kShares[c] * xyz(du); }

#ifdef VOLUME
/// Energy of a cell for the four shares.
vec4 cellEnergies(uint slot, BodyParams body) {
  vec3 u[8];
  vec4 du[8];
  for (uint c = 0u; c < 8u; ++c) {
    int corner = int(cornerSlot(slot, c));
    u[c] = xyz(texelFetch(displacement, corner));
    du[c] = texelFetch(increment, corner);
  }
  vec4 sum = vec4(0.0f);
  for (int g = 0; g < 4; ++g) {
    vec3 at[8], edge_lengths;
    for (int c = 0; c < 8; ++c) at[c] = u[c] + share(du[c], g);
    sum[g] = volumeEnergy(cellBulk(slot, body), shapeOf(at, body.origin_spacing.w, edge_lengths).e);
  }
  return sum;
}
#endif

/// Adds a spring's elastic energy and what its dashpot adds to P, for the four shares.
/// @param near, far  increments of its ends   @param w  u_far - u_near   @param d, l0, prestrain  at rest
void addSpring(vec4 near, vec4 far, vec3 w, vec3 d, float l0, float prestrain, float k, float damping, INOUT(vec4) elastic, INOUT(vec4) damped) {
  for (int c = 0; c < 4; ++c) {
    vec3 along = share(far, c) - share(near, c);
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
  vec4 du = texelFetch(increment, int(slot));
  vec3 u = xyz(texelFetch(displacement, int(slot)));
  vec4 elastic = vec4(0.0f), potential = vec4(0.0f), motion = vec4(0.0f);
  if (du.w == 0.0f) {
    vec3 y = freeIncrement(slot, body), v = xyz(texelFetch(velocity, int(slot)));
    for (int c = 0; c < 4; ++c) {
      vec3 way = share(du, c), off = way - y;
      potential[c] = 0.5f * inertia(mass, body) * dot(off, off);
      motion[c] = 0.5f * mass * dot(way, way) / (dt_s * dt_s) - mass * dot(gravity, way);
    }
    motion[0] = 0.5f * mass * dot(v, v);
  }
#define VISIT_LINK                                                                                              \
  if (counted) addSpring(du, texelFetch(increment, int(n)), xyz(texelFetch(displacement, int(n))) - u, d, l0,     \
                         prestrain, k, damping(k, body), elastic, potential);
  FOR_EACH_LINK
#undef VISIT_LINK
#ifdef VOLUME
  if ((bits.lo & kCellBit) != 0u) elastic += cellEnergies(slot, body);
#endif
  energies[ENERGIES_PER_NODE * i] = potential + elastic;
  energies[ENERGIES_PER_NODE * i + 1u] = motion + elastic;
}
#endif

#ifdef SCALE
#ifndef __cplusplus
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec4 du = increments[slot];
  if (du.w == 0.0f) increments[slot] = vec4(xyz(du) * uintBitsToFloat(guard[0]), 0.0f);
}
#endif

#ifdef CELLS
#ifndef __cplusplus
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
layout(location = 7) uniform uint iteration;
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;  // of cells
  uint slot = cells[i];
  NodeBits bits = nodes[slot];
  vec4 pa = vec4(0.0f), pb = vec4(0.0f), pc = vec4(0.0f);
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
    vec3 at[8], edge_lengths;
    for (uint c = 0u; c < 8u; ++c) {
      int corner = int(cornerSlot(slot, c));
      at[c] = xyz(texelFetch(displacement, corner)) + xyz(texelFetch(increment, corner));
    }
    CellShape s = shapeOf(at, h, edge_lengths);
    float p = volumePressure(bulk, s.e) * 0.25f / h;
    pa = vec4(p * s.bc, volumeMajoriser(bulk, s, edge_lengths, reach(h, iteration), h));
    pb = vec4(p * s.ca, 0.0f);
    pc = vec4(p * s.ab, 0.0f);
  }
  cell_forces_out[3u * slot] = pa;
  cell_forces_out[3u * slot + 1u] = pb;
  cell_forces_out[3u * slot + 2u] = pc;
}
#endif

#ifdef END
#ifndef __cplusplus
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#endif

#ifdef TOOLS
/// The velocity that the lattice alone would have given a held node: its tool's momentum is counted from there.
vec3 velocityWithoutTool(uint slot, NodeBits bits, float mass, BodyParams body, vec3 u, vec3 du) {
  vec3 force = vec3(0.0f);
#define VISIT_LINK force += implicitSpring(n, u, du, d, l0, prestrain, k, body).force;
  FOR_EACH_LINK
#undef VISIT_LINK
#ifdef VOLUME
  force += xyz(volumeForce(slot));
#endif
  return (xyz(texelFetch(velocity, int(slot))) + dt_s * (force / mass + gravity)) / (1.0f + body.drag_per_s * dt_s);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = xyz(texelFetch(displacement, int(slot)));
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(0.0f);
    return;
  }
  vec3 du = xyz(texelFetch(increment, int(slot)));
  vec3 u_next = u + du, v_next = du / dt_s;
#ifdef TOOLS
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  if ((bits.lo & kGrabMask) != 0u) v_next = velocityWithoutTool(slot, bits, mass, body, u, du);
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
#endif
#endif
