// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a node, a spring and a cell are made of (physics.md 1). After lattice.glsl.
// Features: LATTICE (some body has implicit connections), NETWORK (some body has explicit ones: network.glsl), PARTS (strengths differ within a body: tables), VOLUME (cells have an energy of volume), INCREMENT (implicit
// integrators: the state is displacement + increment).
#include "spring.glsl"
#include "volume.glsl"

#ifndef __cplusplus
layout(binding = kUnitDisplacement) uniform samplerBuffer displacement;
layout(binding = kUnitVelocity) uniform samplerBuffer velocity;
#ifdef INCREMENT
layout(binding = kUnitIncrement) uniform samplerBuffer increment;
#endif

#if defined(PARTS) || defined(NETWORK)
layout(binding = kUnitNodeMass) uniform samplerBuffer node_mass;                // [slots]
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return texelFetch(node_mass, int(slot)).x; }
#else
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return float((bits.lo >> kMassShift) & 15u) * body.mass_eighth_kg; }
#endif
#ifdef PARTS
layout(binding = kUnitSpringStiffness) uniform samplerBuffer spring_stiffness;  // [9 * slots]
layout(binding = kUnitCellBulk) uniform samplerBuffer cell_bulk;                // [slots]
float cellBulk(uint slot, BodyParams body) { return texelFetch(cell_bulk, int(slot)).x; }
/// Stiffness [N/m] of a spring that is alive, the same number from both ends. @param far  slot of the other end
float springStiffness(uint slot, uint far, uint spring, uint count, BodyParams body) {
  uint owner = (spring & 1u) == 0u ? slot : far;
  return texelFetch(spring_stiffness, int(owner * (kSpringsPerNode / 2u) + (spring >> 1))).x;
}
#else
float cellBulk(uint slot, BodyParams body) { return body.bulk_j; }
float springStiffness(uint slot, uint far, uint spring, uint count, BodyParams body) {
  return float(count) * (spring < kAxialSprings ? body.axial_quarter_n_per_m : body.diagonal_half_n_per_m);
}
#endif
#ifdef VOLUME
layout(binding = kUnitCellForces) uniform samplerBuffer cell_forces;  // [3 * slots], of volume.comp
#endif
#endif  // __cplusplus

// FOR_EACH_LINK does what a kernel has put into VISIT_LINK for every live spring of the node `slot` with `bits` and `body`: with
// n (slot of the far end), k [N/m], d (rest offset to n [m]), l0 (rest length [m]), prestrain (spring.glsl), and counted, which is
// true at one of its two ends.
#define LATTICE_LINK(spring, offset)                                                                     \
  {                                                                                                      \
    uint count = springCount(bits, spring);                                                              \
    if (count != 0u) {                                                                                   \
      const bool counted = (spring & 1u) == 0u;                                                          \
      const float prestrain = 0.0f;                                                                      \
      uint n = neighborSlot(slot, offset);                                                               \
      float k = springStiffness(slot, n, spring, count, body);                                           \
      float l0 = spring < kAxialSprings ? body.origin_spacing.w : kSqrt2 * body.origin_spacing.w;        \
      vec3 d = body.origin_spacing.w * vec3(offset);                                                     \
      VISIT_LINK                                                                                         \
    }                                                                                                    \
  }
#ifdef NETWORK
#include "network.glsl"
#endif
#if defined(LATTICE) && defined(NETWORK)
#define FOR_EACH_LINK                                                                                    \
  if (body.connections == kImplicit) {                                                                   \
    FOR_EACH_SPRING(LATTICE_LINK)                                                                        \
  } else {                                                                                               \
    FOR_EACH_NETWORK_LINK                                                                                \
  }
#elif defined(NETWORK)
#define FOR_EACH_LINK FOR_EACH_NETWORK_LINK
#else
#define FOR_EACH_LINK FOR_EACH_SPRING(LATTICE_LINK)
#endif

#ifdef VOLUME
/// Calls APPLY(corner) for the eight corners that a node is of the cells around it, as -1 | +1 per axis.
#define FOR_EACH_CELL(APPLY)                                                      \
  APPLY(ivec3(-1, -1, -1)) APPLY(ivec3(1, -1, -1)) APPLY(ivec3(-1, 1, -1))        \
  APPLY(ivec3(1, 1, -1)) APPLY(ivec3(-1, -1, 1)) APPLY(ivec3(1, -1, 1))           \
  APPLY(ivec3(-1, 1, 1)) APPLY(ivec3(1, 1, 1))

/// Lowest corner of the cell in which a node is this corner; exists says whether its brick is there.
uint cellAt(uint slot, ivec3 corner, OUT(bool) exists) {
  ivec3 p = localCoord(slot) - ((corner + 1) >> 1);  // -1 .. 3
  ivec3 side = (p + 4) >> 2;                          // 0, 1
  uint brick = neighborBrick(slot, uint(side.x + 3 * side.y + 9 * side.z));
  exists = brick != (slot >> 6) || side == ivec3(1);
  uvec3 q = uvec3(p & 3);
  return brick * kBrickSlots + q.x + 4u * q.y + 16u * q.z;
}

/// Force of the volume of the cells around a node [N]; w their Jacobi majorisers [N/m].
vec4 volumeForce(uint slot) {
  vec4 sum = vec4(0.0f);
#define ADD_CELL(corner)                                                                                        \
  {                                                                                                             \
    bool exists;                                                                                                \
    int cell = 3 * int(cellAt(slot, corner, exists));                                                           \
    if (exists) {                                                                                               \
      vec4 pa = texelFetch(cell_forces, cell);                                                                  \
      vec3 s = vec3(corner);                                                                                    \
      sum += vec4(-(s.x * xyz(pa) + s.y * xyz(texelFetch(cell_forces, cell + 1)) + s.z * xyz(texelFetch(cell_forces, cell + 2))), pa.w); \
    }                                                                                                           \
  }
  FOR_EACH_CELL(ADD_CELL)
  return sum;
}
#endif
