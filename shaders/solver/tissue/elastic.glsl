// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a node, a spring and a cell are made of (physics.md 1). After lattice.glsl.
// Features: LATTICE (some body has implicit connections), NETWORK (some body has explicit ones: network.glsl), PARTS (strengths differ within a body: tables), VOLUME (cells have energies of their own: of volume, by moments), MOMENTS (some have
// the latter), INCREMENT (implicit integrators: the state is displacement + increment).
#include "solver/tissue/spring.glsl"
#include "solver/tissue/volume.glsl"
#include "solver/tissue/moments.glsl"

#ifndef __cplusplus
layout(binding = kUnitDisplacement) uniform samplerBuffer displacement;
layout(binding = kUnitVelocity) uniform samplerBuffer velocity;
#ifdef INCREMENT
layout(binding = kUnitIncrement) uniform samplerBuffer increment;
#endif

#if defined(PARTS) || defined(NETWORK)
layout(binding = kUnitNodeMass) uniform samplerBuffer node_mass;                // [slots]; y as surfaceDepth(), 0 where there is none
/// How deep a node lies below the surface of its tissue at rest, where cells are tissue in part and it is no deeper than a cell [m];
/// negative outside. What touches the tissue is as much nearer to the surface than to the node.
float surfaceDepth(uint slot) { return texelFetch(node_mass, int(slot)).y; }
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return texelFetch(node_mass, int(slot)).x; }
#else
float surfaceDepth(uint slot) { return 0.0f; }
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return float((bits.lo >> kMassShift) & 15u) * body.mass_eighth_kg; }
#endif
#ifdef PARTS
layout(binding = kUnitSpringStiffness) uniform samplerBuffer spring_stiffness;  // [9 * slots]
layout(binding = kUnitCellBulk) uniform samplerBuffer cell_bulk;                // [slots] with MOMENTS: y rigidity, z fill
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
layout(binding = kUnitCellForces) uniform samplerBuffer cell_forces;  // [cell_vectors * slots], of volume.comp
#endif
#ifdef MOMENTS
const bool has_moments = true;
const uint cell_vectors = kMomentVectors;
#ifdef PARTS
layout(binding = kUnitCellMoments) uniform samplerBuffer cell_moments;  // [3 * (1 + fills)]
/// mu h^3 times the cell's share [J]; 0 in bodies whose cells are springs only.
float cellRigidity(uint slot, BodyParams body) { return texelFetch(cell_bulk, int(slot)).y; }
CellMoments cellMoments(uint slot) {
  int fill = 3 * int(texelFetch(cell_bulk, int(slot)).z);
  CellMoments t = {texelFetch(cell_moments, fill).xyz, texelFetch(cell_moments, fill + 1).xyz, texelFetch(cell_moments, fill + 2).xyz};
  return t;
}
#else
float cellRigidity(uint slot, BodyParams body) { return body.rigidity_j; }
CellMoments cellMoments(uint slot) { return fullMoments(); }
#endif
#else
const bool has_moments = false;
const uint cell_vectors = kVolumeVectors;
float cellRigidity(uint slot, BodyParams body) { return 0.0f; }
CellMoments cellMoments(uint slot) { return fullMoments(); }
#endif
#else
CellMoments cellMoments(uint slot) { return has_moments ? momentsAt<CellMoments>(slot) : fullMoments(); }
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
#include "solver/tissue/network.glsl"
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

/// What a cell's energies do to its corners, as volume.comp and implicit_cells.comp leave it: the corner at (x, y, z), each -1
/// or 1, feels minus x a + y b + z c + y z hx + z x hy + x y hz + x y z hxyz [N].
struct CellForces {
  vec3 a, b, c, hx, hy, hz, hxyz;
};

/// @param at  displacements of the corners, bit per axis, x lowest [m]   @param p  volumePressure over 4 h [N]
/// @param rigidity  0: none by moments
CellForces cellForces(vec3 at[8], CellShape shape, float p, float h, float bulk, float rigidity, CellMoments moments) {
  CellForces f = {p * shape.bc, p * shape.ca, p * shape.ab, vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
  if (rigidity <= 0.0f) return f;
  CellPull pull = cellPull(cellMotion(at, h), moments, rigidity, bulk);
  float quarter = 0.25f / h;
  f.a += quarter * pull.a;
  f.b += quarter * pull.b;
  f.c += quarter * pull.c;
  f.hx = (2.0f * quarter) * pull.hx;
  f.hy = (2.0f * quarter) * pull.hy;
  f.hz = (2.0f * quarter) * pull.hz;
  f.hxyz = (0.35355339f / h) * pull.hxyz;
  return f;
}

/// @param s  which corner, -1 or 1 per axis
vec3 cornerForce(CellForces f, vec3 s) {
  return -(s.x * f.a + s.y * f.b + s.z * f.c) - (s.y * s.z * f.hx + s.z * s.x * f.hy + s.x * s.y * f.hz) - (s.x * s.y * s.z) * f.hxyz;
}

/// Energy of a cell [J].
float cellEnergy(vec3 at[8], float e, float h, float bulk, float rigidity, CellMoments moments) {
  float energy = volumeEnergy(bulk, e);
  if (rigidity <= 0.0f) return energy;
  return energy + cellPull(cellMotion(at, h), moments, rigidity, bulk).energy;
}

/// The part of a cell's forces that its hourglass motions make. @param cell  first of its vectors
vec3 bent(int cell, vec3 s) {
  return (s.y * s.z) * xyz(texelFetch(cell_forces, cell + 3)) + (s.z * s.x) * xyz(texelFetch(cell_forces, cell + 4)) +
         (s.x * s.y) * xyz(texelFetch(cell_forces, cell + 5)) + (s.x * s.y * s.z) * xyz(texelFetch(cell_forces, cell + 6));
}

/// Force of the cells around a node [N]; w their Jacobi majorisers [N/m].
vec4 volumeForce(uint slot) {
  vec4 sum = vec4(0.0f);
#define ADD_CELL(corner)                                                                                        \
  {                                                                                                             \
    bool exists;                                                                                                \
    int cell = int(cell_vectors * cellAt(slot, corner, exists));                                                \
    if (exists) {                                                                                               \
      vec4 pa = texelFetch(cell_forces, cell);                                                                  \
      vec3 s = vec3(corner);                                                                                    \
      sum += vec4(-(s.x * xyz(pa) + s.y * xyz(texelFetch(cell_forces, cell + 1)) + s.z * xyz(texelFetch(cell_forces, cell + 2))), pa.w); \
      if (has_moments) sum -= vec4(bent(cell, s), 0.0f);                                                         \
    }                                                                                                           \
  }
  FOR_EACH_CELL(ADD_CELL)
  return sum;
}
#endif
