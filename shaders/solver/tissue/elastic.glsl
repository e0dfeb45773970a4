// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Properties of nodes, springs and cells (physics.md 1). After lattice.glsl.
// Features: LATTICE (some body has implicit connections), NETWORK (some body has explicit ones: network.glsl), PARTS (strengths
// vary within a body: tables), LAW (the cells of some bodies obey a hyperelastic law), PRESTRESS (some of these are stressed at
// rest), LAMINATES (some have two materials), WALLS (some are in thin walls: law_walls.glsl), INCREMENT (implicit integrators:
// the state is displacement + increment), MAKES_CELL_FORCES (of kernels that do).
#include "solver/tissue/spring.glsl"
#include "solver/tissue/cell_modes.glsl"
#ifdef LAW
#include "solver/tissue/law.glsl"
#endif

#ifndef __cplusplus
#ifdef LOADS
layout(std430, binding = kBindDisplacementIn) restrict readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindVelocityIn) restrict readonly buffer VelocityIn { vec4 velocity[]; };
#else
layout(binding = kUnitDisplacement) uniform samplerBuffer displacement;
layout(binding = kUnitVelocity) uniform samplerBuffer velocity;
#endif
#if defined(INCREMENT) && defined(LOADS)
layout(std430, binding = kBindIncrement) restrict readonly buffer IncrementIn { vec4 increment[]; };
#elif defined(INCREMENT)
layout(binding = kUnitIncrement) uniform samplerBuffer increment;
#endif

#if defined(PARTS) || defined(NETWORK)
layout(binding = kUnitNodeMass) uniform samplerBuffer node_mass;                // [slots]; y as surfaceDepth(), 0 where there is none
/// Returns the depth of a node below the surface of its tissue at rest, where cells are partially filled and it is at most a cell
/// [m]; negative outside. Contact is with the surface, offset from the node by it.
float surfaceDepth(uint slot) { return texelFetch(node_mass, int(slot)).y; }
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return texelFetch(node_mass, int(slot)).x; }
#else
float surfaceDepth(uint slot) { return 0.0f; }
float nodeMass(uint slot, NodeBits bits, BodyParams body) { return float((bits.lo >> kMassShift) & 15u) * body.mass_eighth_kg; }
#endif
#ifdef PARTS
#ifdef LOADS
layout(std430, binding = kBindSpringStiffness) restrict readonly buffer SpringStiffnessIn { float spring_stiffness[]; };  // [9 * slots]
float stiffnessAt(uint position) { return spring_stiffness[position]; }
#else
layout(binding = kUnitSpringStiffness) uniform samplerBuffer spring_stiffness;  // the same
float stiffnessAt(uint position) { return texelFetch(spring_stiffness, int(position)).x; }
#endif
#if defined(LAW) && defined(LOADS)
layout(std430, binding = kBindCellStrengths) restrict readonly buffer CellStrengthsIn { vec4 cell_strengths[]; };  // [slots]
vec4 cellStrengths(uint slot) { return cell_strengths[slot]; }
#elif defined(LAW)
layout(binding = kUnitCellBulk) uniform samplerBuffer cell_bulk;  // [slots] x bulk, y rigidity [J], z index of the moments
vec4 cellStrengths(uint slot) { return texelFetch(cell_bulk, int(slot)); }
#endif
/// Returns the stiffness [N/m] of a whole spring, the same number from both ends. @param far  slot of the other end
float springStiffness(uint slot, uint far, uint spring, uint count, BodyParams body) {
  uint owner = (spring & 1u) == 0u ? slot : far;
  return stiffnessAt(inPlanes(owner, spring >> 1, kSpringsPerNode / 2u));
}
#else
float springStiffness(uint slot, uint far, uint spring, uint count, BodyParams body) {
  return float(count) * (spring < kAxialSprings ? body.axial_quarter_n_per_m : body.diagonal_half_n_per_m);
}
#endif
#ifndef MAKES_CELL_FORCES
#if defined(LAW) && defined(LOADS)
layout(std430, binding = kBindCellForces) restrict readonly buffer CellForcesIn { vec4 cell_forces[]; };  // [kCellVectors * slots], of cell_forces.comp
#elif defined(LAW)
layout(binding = kUnitCellForces) uniform samplerBuffer cell_forces;  // the same
#endif
#endif
#if defined(LAW) && defined(PARTS)
layout(binding = kUnitCellMoments) uniform samplerBuffer cell_moments;  // [3 * (1 + fills)], then stresses, laminates and walls of cells, two each (JoinedMoments)
/// Return (lambda - mu) h^3 and mu h^3, times the cell's share [J].
float cellBulk(uint slot, BodyParams body) { return cellStrengths(slot).x; }
float cellRigidity(uint slot, BodyParams body) { return cellStrengths(slot).y; }
CellMoments cellMoments(uint slot) {
  vec4 strengths = cellStrengths(slot);
  int fill = 3 * int(strengths.z);
  CellMoments t;
  vec4 first = texelFetch(cell_moments, fill);
  t.first = first.xyz;
  vec4 square = texelFetch(cell_moments, fill + 1);
  t.square = square.xyz;
  t.mixed = texelFetch(cell_moments, fill + 2).xyz;
#ifdef PRESTRESS
  int stress = int(strengths.w);
  t.pulled = stress == 0 ? vec3(0.0f) : texelFetch(cell_moments, stress).xyz;
  t.sheared = stress == 0 ? vec3(0.0f) : texelFetch(cell_moments, stress + 1).xyz;
#endif
#ifdef LAMINATES
  int laminate = int(first.w);
  t.plane = laminate == 0 ? vec4(0.0f, 0.0f, 0.0f, 1.0f) : texelFetch(cell_moments, laminate);
  t.layers = laminate == 0 ? vec4(1.0f) : texelFetch(cell_moments, laminate + 1);
#endif
#ifdef WALLS
  int wall = int(square.w);
  t.wall = wall == 0 ? vec4(0.0f) : texelFetch(cell_moments, wall);
  t.variation = wall == 0 ? 0.0f : texelFetch(cell_moments, wall + 1).x;
#endif
  return t;
}
#elif defined(LAW)
float cellBulk(uint slot, BodyParams body) { return body.bulk_j; }
float cellRigidity(uint slot, BodyParams body) { return body.rigidity_j; }
CellMoments cellMoments(uint slot) { return fullMoments(); }
#endif
#endif  // __cplusplus

// A kernel that defines DEAD_LINKS also visits springs that are cut, with k = 0, and missing cells. A GPU then issues all loads
// of a node at once; with a branch around each they would wait for each other.
#ifdef DEAD_LINKS
#define IF_ALIVE(count)
#define OF_ALIVE(count, k) ((count) != 0u ? (k) : 0.0f)
#define IF_THERE(exists)
#define OF_THERE(exists, of_cell) ((exists) ? (of_cell) : vec4(0.0f))
#else
#define IF_ALIVE(count) if ((count) != 0u)
#define OF_ALIVE(count, k) (k)
#define IF_THERE(exists) if (exists)
#define OF_THERE(exists, of_cell) (of_cell)
#endif

// FOR_EACH_LINK executes the kernel's VISIT_LINK for every whole spring of the node `slot` with `bits` and `body`. It defines n
// (slot of the far end), k [N/m], d (rest offset to n [m]), l0 (rest length [m]), prestrain (spring.glsl), and counted, which is
// true at one of its two ends.
#define LATTICE_LINK(spring, offset)                                                                     \
  {                                                                                                      \
    uint count = springCount(bits, spring);                                                              \
    IF_ALIVE(count) {                                                                                    \
      const bool counted = (spring & 1u) == 0u;                                                          \
      const float prestrain = 0.0f;                                                                      \
      uint n = neighborSlot(slot, offset);                                                               \
      float k = OF_ALIVE(count, springStiffness(slot, n, spring, count, body));                          \
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

/// Calls APPLY(corner) for the corner that a node is in each of the eight cells around it, as -1 | +1 per axis.
#define FOR_EACH_CELL(APPLY)                                                      \
  APPLY(ivec3(-1, -1, -1)) APPLY(ivec3(1, -1, -1)) APPLY(ivec3(-1, 1, -1))        \
  APPLY(ivec3(1, 1, -1)) APPLY(ivec3(-1, -1, 1)) APPLY(ivec3(1, -1, 1))           \
  APPLY(ivec3(-1, 1, 1)) APPLY(ivec3(1, 1, 1))

/// Returns the lowest corner of the cell in which a node is this corner; `exists` is set to whether its brick exists.
uint cellAt(uint slot, ivec3 corner, OUT(bool) exists) {
  ivec3 p = localCoord(slot) - ((corner + 1) >> 1);  // -1 .. 3
  ivec3 side = (p + 4) >> 2;                          // 0, 1
  uint brick = neighborBrick(slot, uint(side.x + 3 * side.y + 9 * side.z));
  exists = brick != (slot >> 6) || side == ivec3(1);
  uvec3 q = uvec3(p & 3);
  return brick * kBrickSlots + q.x + 4u * q.y + 16u * q.z;
}

#ifdef LAW
/// Forces of a cell on its corners. The force on the corner at (x, y, z), each -1 or 1, is minus x a + y b + z c + y z hx + z x
/// hy + x y hz + x y z hxyz [N].
struct CellForces {
  vec3 a, b, c, hx, hy, hz, hxyz;
#ifdef WALLS
  CellRows rows;  // derivatives of the energy by these [J]; only where CellMoments has a wall
#endif
};

/// @param q  from cellMotion()   @param bulk, rigidity  as in lawPull()
CellForces lawForces(CellModes q, BodyParams body, float bulk, float rigidity, CellMoments moments) {
  float h = body.origin_spacing.w;
  CellForce pull = lawPull(q, moments, rigidity, bulk, body.stiffening);
  float quarter = 0.25f / h;
  CellForces f;
  f.a = quarter * pull.a;
  f.b = quarter * pull.b;
  f.c = quarter * pull.c;
  f.hx = (2.0f * quarter) * pull.hx;
  f.hy = (2.0f * quarter) * pull.hy;
  f.hz = (2.0f * quarter) * pull.hz;
  f.hxyz = (0.35355339f / h) * pull.hxyz;
#ifdef WALLS
  f.rows = pull.rows;
#endif
  return f;
}

/// Returns the index of a corner, bit per axis, x lowest. @param corner  -1 or 1 per axis
uint cornerNumber(ivec3 corner) { return uint((corner.x + 1) / 2 + (corner.y + 1) + 2 * (corner.z + 1)); }

#ifdef WALLS
#define CELL_PLANES (kCellVectors + kRowVectors)
#else
#define CELL_PLANES kCellVectors
#endif
/// Returns the index in cell_forces of a cell's force on one of its corners; from kCellVectors on, of a node's rows, by axis.
uint cellVector(uint slot, uint corner) { return inPlanes(slot, corner, CELL_PLANES); }

#ifdef WALLS
bool isGhost(NodeBits bits) { return (bits.lo & kGhostBit) != 0u; }
/// Returns whether a node has a second difference along an axis: both springs along it are whole, or one of them and the other
/// neighbour is a ghost.
bool isWithinRow(NodeBits bits, uint axis) {
  uint ends = isGhost(bits) ? 0u : (bits.lo >> (kGhostRowShift + axis)) & 1u;
  if (springCount(bits, 2u * axis) != 0u) ++ends;
  if (springCount(bits, 2u * axis + 1u) != 0u) ++ends;
  return ends >= 2u;
}

/// Returns the slot of the neighbour along an axis, as neighborSlot(). @param side  -1 or 1
uint besideInRow(uint slot, uint axis, int side) {
  return neighborSlot(slot, ivec3(axis == 0u ? side : 0, axis == 1u ? side : 0, axis == 2u ? side : 0));
}
#endif

#ifndef MAKES_CELL_FORCES  // kernels that write cell_forces do not read them
/// Returns the force of the cells around a node [N].
vec3 cellForce(uint slot) {
  vec4 sum = vec4(0.0f);
#define ADD_CELL(corner)                                                                      \
  {                                                                                           \
    bool exists;                                                                              \
    uint cell = cellAt(slot, corner, exists);                                                 \
    IF_THERE(exists) {                                                                        \
      vec4 of_corner = stateAt(cell_forces, int(cellVector(cell, cornerNumber(corner))));     \
      sum += OF_THERE(exists, of_corner);                                                     \
    }                                                                                         \
  }
  FOR_EACH_CELL(ADD_CELL)
  return xyz(sum);
}

#ifdef WALLS
/// Returns the force of a node's rows on it, from row_forces.comp [N].
vec3 rowForce(uint slot, NodeBits bits) {
  vec4 sum = vec4(0.0f);
  for (uint axis = 0u; axis < 3u; ++axis) {
    sum += 2.0f * stateAt(cell_forces, int(cellVector(slot, kCellVectors + axis)));
    for (int side = -1; side < 2; side += 2) {
      bool whole = springCount(bits, 2u * axis + (side < 0 ? 1u : 0u)) != 0u;
      IF_THERE(whole) {
        vec4 beside = stateAt(cell_forces, int(cellVector(besideInRow(slot, axis, side), kCellVectors + axis)));
        sum -= OF_THERE(whole, beside);
      }
    }
  }
  return xyz(sum);
}
#endif
#endif
#endif
