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

const vec4 kShares = vec4(0.0, 0.5, 0.75, 1.0);
const float kRounding = 1e-6;  // of sums of energies: differences below it say nothing

/// Two vectors per node: P per share [J]; energy before the substep, then after it with shares 1, 2, 3 [J].
#define ENERGIES_PER_NODE 2u

#ifdef FOLD
const uint kRun = 64u;
layout(std430, binding = kBindPartials) buffer PartialsBuffer { vec4 energies[]; };
layout(std430, binding = kBindGuard) buffer GuardBuffer { uint guard[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint input_first;
layout(location = 2) uniform uint output_first;
layout(location = 3) uniform uint last_level;
layout(location = 4) uniform uint bound_energy;  // 1: a share that ends with more energy than there was is not taken

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

void main() {
  uint run = globalIndex();
  if (run * kRun >= count) return;
  vec4 potential = vec4(0.0), energy = vec4(0.0);
  uint end = min((run + 1u) * kRun, count);
  for (uint i = run * kRun; i < end; ++i) {
    potential += energies[ENERGIES_PER_NODE * (input_first + i)];
    energy += energies[ENERGIES_PER_NODE * (input_first + i) + 1u];
  }
  energies[ENERGIES_PER_NODE * (output_first + run)] = potential;
  energies[ENERGIES_PER_NODE * (output_first + run) + 1u] = energy;
  if (last_level != 0u) guard[0] = floatBitsToUint(kShares[bestShare(potential, energy)]);
}
#else
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#ifdef TOOLS
#include "contact.glsl"
#endif

uint cornerSlot(uint slot, uint c) { return neighborSlot(slot, ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u)); }

#ifdef BEGIN
layout(std430, binding = kBindIncrement) writeonly buffer IncrementBuffer { vec4 increments[]; };

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  increments[slot] = vec4(0.0, 0.0, 0.0, 1.0);
  if (isAtRest(bits)) return;
#ifdef TOOLS
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) {
    increments[slot] = vec4(heldDisplacement(held_by - 1u, slot) - texelFetch(displacement, int(slot)).xyz, 1.0);
    return;
  }
#endif
  increments[slot] = vec4(freeIncrement(slot, bodies[bodyOf(bits)]), 0.0);
}
#endif

#ifdef GUESS
layout(std430, binding = kBindPartials) writeonly buffer PartialsBuffer { vec4 energies[]; };

vec3 share(vec4 du, int c) { return du.w != 0.0 ? du.xyz : kShares[c] * du.xyz; }

#ifdef VOLUME
/// Energy of a cell for the four shares.
vec4 cellEnergies(uint slot, BodyParams body) {
  vec3 u[8];
  vec4 du[8];
  for (uint c = 0u; c < 8u; ++c) {
    int corner = int(cornerSlot(slot, c));
    u[c] = texelFetch(displacement, corner).xyz;
    du[c] = texelFetch(increment, corner);
  }
  vec4 sum = vec4(0.0);
  for (int g = 0; g < 4; ++g) {
    vec3 at[8], edge_lengths;
    for (int c = 0; c < 8; ++c) at[c] = u[c] + share(du[c], g);
    sum[g] = volumeEnergy(cellBulk(slot, body), shapeOf(at, body.origin_spacing.w, edge_lengths).e);
  }
  return sum;
}
#endif

/// Adds a spring's elastic energy and what its dashpot adds to P, for the four shares.
/// @param near, far  increments of its ends   @param w  u_far - u_near   @param d, l0  at rest
void addSpring(vec4 near, vec4 far, vec3 w, vec3 d, float l0, float k, float damping, inout vec4 elastic, inout vec4 damped) {
  for (int c = 0; c < 4; ++c) {
    vec3 along = share(far, c) - share(near, c);
    Spring s = springBetween(d, l0, w + along);
    float rate = dot(s.direction, along);
    elastic[c] += 0.5 * k * s.extension * s.extension;
    damped[c] += 0.5 * damping * rate * rate;
  }
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  float h = body.origin_spacing.w, mass = nodeMass(slot, bits, body);
  vec4 du = texelFetch(increment, int(slot));
  vec3 u = texelFetch(displacement, int(slot)).xyz;
  vec4 elastic = vec4(0.0), potential = vec4(0.0), motion = vec4(0.0);
  if (du.w == 0.0) {
    vec3 y = freeIncrement(slot, body), v = texelFetch(velocity, int(slot)).xyz;
    for (int c = 0; c < 4; ++c) {
      vec3 way = share(du, c), off = way - y;
      potential[c] = 0.5 * inertia(mass, body) * dot(off, off);
      motion[c] = 0.5 * mass * dot(way, way) / (dt_s * dt_s) - mass * dot(gravity, way);
    }
    motion[0] = 0.5 * mass * dot(v, v);
  }
#define ADD_ENERGY(spring, offset)                                                                              \
  if ((spring & 1u) == 0u) {                                                                                    \
    uint count = springCount(bits, spring);                                                                     \
    if (count != 0u) {                                                                                          \
      uint n = neighborSlot(slot, offset);                                                                      \
      float k = springStiffness(slot, n, spring, count, body), l0 = spring < kAxialSprings ? h : kSqrt2 * h;    \
      addSpring(du, texelFetch(increment, int(n)), texelFetch(displacement, int(n)).xyz - u, h * vec3(offset),  \
                l0, k, damping(k, body), elastic, potential);                                                   \
    }                                                                                                           \
  }
  FOR_EACH_SPRING(ADD_ENERGY)
#ifdef VOLUME
  if ((bits.lo & kCellBit) != 0u) elastic += cellEnergies(slot, body);
#endif
  energies[ENERGIES_PER_NODE * i] = potential + elastic;
  energies[ENERGIES_PER_NODE * i + 1u] = motion + elastic;
}
#endif

#ifdef SCALE
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  if (increments[slot].w == 0.0) increments[slot].xyz *= uintBitsToFloat(guard[0]);
}
#endif

#ifdef CELLS
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
layout(location = 7) uniform uint iteration;

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;  // of cells
  uint slot = cells[i];
  NodeBits bits = nodes[slot];
  vec4 pa = vec4(0.0), pb = vec4(0.0), pc = vec4(0.0);
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
    vec3 at[8], edge_lengths;
    for (uint c = 0u; c < 8u; ++c) {
      int corner = int(cornerSlot(slot, c));
      at[c] = texelFetch(displacement, corner).xyz + texelFetch(increment, corner).xyz;
    }
    CellShape s = shapeOf(at, h, edge_lengths);
    float p = volumePressure(bulk, s.e) * 0.25 / h;
    pa = vec4(p * s.bc, volumeMajoriser(bulk, s, edge_lengths, reach(h, iteration), h));
    pb = vec4(p * s.ca, 0.0);
    pc = vec4(p * s.ab, 0.0);
  }
  cell_forces_out[3u * slot] = pa;
  cell_forces_out[3u * slot + 1u] = pb;
  cell_forces_out[3u * slot + 2u] = pc;
}
#endif

#ifdef END
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };

#ifdef TOOLS
/// The velocity that the lattice alone would have given a held node: its tool's momentum is counted from there.
vec3 velocityWithoutTool(uint slot, NodeBits bits, float mass, BodyParams body, vec3 u, vec3 du) {
  float h = body.origin_spacing.w;
  vec3 force = vec3(0.0);
#define VISIT_SPRING force += s.force;
  FOR_EACH_SPRING(IMPLICIT_SPRING)
#ifdef VOLUME
  force += volumeForce(slot).xyz;
#endif
  return (texelFetch(velocity, int(slot)).xyz + dt_s * (force / mass + gravity)) / (1.0 + body.drag_per_s * dt_s);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = texelFetch(displacement, int(slot)).xyz;
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0);
    next_velocity[slot] = vec4(0.0);
    return;
  }
  vec3 du = texelFetch(increment, int(slot)).xyz;
  vec3 u_next = u + du, v_next = du / dt_s;
#ifdef TOOLS
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  if ((bits.lo & kGrabMask) != 0u) v_next = velocityWithoutTool(slot, bits, mass, body, u, du);
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0);
  next_velocity[slot] = vec4(v_next, 0.0);
}
#endif
#endif
