// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vbd.comp - vertex block descent: one colour's nodes, in place.   Owner: solver/gpu/vbd_pass.h   physics.md 2
// in  displacement, velocity, increments of the other colours     in/out  increments of this colour
// Each node goes to the minimum of the incremental potential (implicit.glsl) over its own increment, the others' fixed: one
// Newton step with the 3x3 block
//   m (1 + gamma dt)/dt^2 + sum of k (n n^T + max(0, 1 - l0/L)(1 - n n^T)) + c/dt n n^T + sum over cells of W'' g g^T
// or, where that step is not sure to descend, one with k for the springs, which is: k/2 (L - l0)^2 <= k/2 |edge - l0 n|^2.
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#ifdef CONTACT
#include "implicit_contact.glsl"
#endif

#ifndef __cplusplus
layout(std430, binding = kBindIncrement) writeonly buffer IncrementBuffer { vec4 increments[]; };
uniform uint colour_first;  // of this colour in active_nodes, which holds active_count of them
#endif

/// Newton's step is sure to descend if |s| <= kLongest L and r.s >= kSteep sum of k |s|^3 / L, L the shortest spring: what the
/// block leaves out of a spring's energy is below 0.23 k |s|^3 / L then, and the block promises r.s / 2.
const float kLongest = 0.1f;
const float kSteep = 0.5f;

/// What pulls a node and how stiffly.
struct Block {
  vec3 force;         // less the gradient of the incremental potential [N]
  mat3 springs;       // sum of k (1 - stretch) n n^T
  float across;       // sum of k stretch
  float stiffness;    // sum of k
  float shortest;     // L of the shortest spring [m]
  mat3 bounded;       // dashpots and volumes: quadratic, or bounded by what is here, however long the step
};

void addSprings(uint slot, NodeBits bits, BodyParams body, vec3 u, vec3 du, INOUT(Block) block) {
#define VISIT_LINK                                                                  \
  ImplicitSpring s = implicitSpring(n, u, du, d, l0, prestrain, k, body);           \
  mat3 along = outerProduct(s.spring.direction, s.spring.direction);                \
  block.force += s.force;                                                           \
  block.springs += (k * (1.0f - s.stretch)) * along;                                 \
  block.bounded += s.damping * along;                                                \
  block.across += k * s.stretch;                                                    \
  block.stiffness += k;                                                             \
  block.shortest = min(block.shortest, l0 + s.spring.extension);
  FOR_EACH_LINK
#undef VISIT_LINK
}

#ifdef VOLUME
int aroundIndex(ivec3 offset) { return (offset.x + 1) + 3 * (offset.y + 1) + 9 * (offset.z + 1); }

/// A cell's V/V0 is an affine function of one corner, e + g.s, so its energy's curvature is W'' g g^T, and W'' has a bound. What
/// moments add is bounded by what the block has of the springs (physics.md 1).
void addCells(uint slot, BodyParams body, INOUT(Block) block) {
  float h = body.origin_spacing.w;
  vec3 around[27];
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        int n = int(neighborSlot(slot, ivec3(x, y, z)));
        around[aroundIndex(ivec3(x, y, z))] = xyz(texelFetch(displacement, n)) + xyz(texelFetch(increment, n));
      }
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 here = ivec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);  // of this node in the cell
    bool exists;
    uint cell = cellAt(slot, 2 * here - 1, exists);
    if (!exists || (nodes[cell].lo & kCellBit) == 0u) continue;
    vec3 at[8];
    for (int c = 0; c < 8; ++c) at[c] = around[aroundIndex(ivec3(c & 1, (c >> 1) & 1, (c >> 2) & 1) - here)];
    vec3 edge_lengths;
    CellShape shape = shapeOf(at, h, edge_lengths);
    vec3 s = vec3(2 * here - 1);
    vec3 g = (s.x * shape.bc + s.y * shape.ca + s.z * shape.ab) * (0.25f / h);
    float bulk = cellBulk(cell, body);
    block.force -= volumePressure(bulk, shape.e) * g;
    block.bounded += volumeBounds(bulk, 0.0f, 0.0f).x * outerProduct(g, g);
    float rigidity = cellRigidity(cell, body);
    if (rigidity > 0.0f) block.force += cornerForce(cellForces(at, shape, 0.0f, h, bulk, rigidity, cellMoments(cell)), s);
  }
}
#endif

vec3 descent(float inertia_n_per_m, Block block) {
  vec3 s = solved(inertia_n_per_m + block.across, block.springs + block.bounded, block.force);
  float size = length(s);
  bool sure = size <= kLongest * block.shortest &&
              dot(block.force, s) * block.shortest >= kSteep * block.stiffness * size * size * size;
  // Not finite is not sure: comparisons with it fail.
  return sure ? s : solved(inertia_n_per_m + block.stiffness, block.bounded, block.force);
}

#ifdef CONTACT
/// The same where contacts let the node be. Its model promises s H s / 2.
vec3 descentInContact(uint slot, float inertia_n_per_m, Block block, vec3 du) {
  float diagonal = inertia_n_per_m + block.across;
  mat3 a = block.springs + block.bounded;
  vec3 s = stepInContact(slot, diagonal, a, du, block.force, true);
  float size = length(s);
  bool sure = size <= kLongest * block.shortest &&
              dot(s, diagonal * s + a * s) * block.shortest >= kSteep * block.stiffness * size * size * size;
  return sure ? s : stepInContact(slot, inertia_n_per_m + block.stiffness, block.bounded, du, block.force, true);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[colour_first + i];
  vec4 start = texelFetch(increment, int(slot));
  if (isPrescribed(start) || isInPairs(start)) return;  // the latter move together (implicit_pull.comp)
  vec3 du = xyz(start), u = xyz(texelFetch(displacement, int(slot)));
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  float inertia_n_per_m = inertia(nodeMass(slot, bits, body), body);
  Block block = {inertia_n_per_m * (freeIncrement(slot, body) - du), mat3(0.0f), 0.0f, 0.0f, 1e30f, mat3(0.0f)};
  addSprings(slot, bits, body, u, du, block);
#ifdef VOLUME
  addCells(slot, body, block);
#endif
  vec3 s = descent(inertia_n_per_m, block);
#ifdef CONTACT
  findContacts(slot, u, du + s);
  if (contactCount(slot) != 0u) {
    increments[slot] = vec4(du + descentInContact(slot, inertia_n_per_m, block, du), -1.0f);
    return;
  }
#endif
  increments[slot] = vec4(du + s, 0.0f);
}
