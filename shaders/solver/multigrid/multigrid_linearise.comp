// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_linearise.comp - forces on nodes where an increment leads, their tangents, and the inverse of its block diagonal.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  places, speeds; cell forces, tangents of cells     out  forces, tangents of springs, inverse; partial sums of energy
// Springs are made positive, k (n n^T + max(0, 1 - l0/L)(1 - n n^T)); dashpots add c rate n n^T; volumes count as B g g^T.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"
#include "solver/multigrid/multigrid_springs.glsl"
#include "solver/multigrid/multigrid_sums.glsl"
#ifdef VOLUME
#include "solver/multigrid/multigrid_cell_tangents.glsl"
#endif

uniform float inertia;  // a0 [1/s2]
uniform float rate;     // d velocity / d displacement [1/s]

/// A symmetric block.
struct Symmetric {
  float xx, xy, xz, yy, yz, zz;
};
void addSquare(vec3 s, inout Symmetric to) {
  to.xx += s.x * s.x;
  to.xy += s.x * s.y;
  to.xz += s.x * s.z;
  to.yy += s.y * s.y;
  to.yz += s.y * s.z;
  to.zz += s.z * s.z;
}
void addIdentity(float t, inout Symmetric to) {
  to.xx += t;
  to.yy += t;
  to.zz += t;
}

void storeInverse(Symmetric d, uint slot, float own, float moves) {
  Symmetric c = {d.yy * d.zz - d.yz * d.yz, d.xz * d.yz - d.xy * d.zz, d.xy * d.yz - d.xz * d.yy,
                 d.xx * d.zz - d.xz * d.xz, d.xy * d.xz - d.xx * d.yz, d.xx * d.yy - d.xy * d.xy};
  float determinant = d.xx * c.xx + d.xy * c.xy + d.xz * c.xz;
  float per = determinant > 0.0f && moves > 0.0f ? 1.0f / determinant : 0.0f;
  system_vectors[kSystemInverse * slot_count + slot] = per * vec4(c.xx, c.xy, c.xz, c.yy);
  system_vectors[kSystemInverse2 * slot_count + slot] = vec4(per * c.yz, per * c.zz, own, moves);
}

#ifdef VOLUME
/// What the volumes of the cells around a node add to its block, where that is positive.
void addVolumes(uint slot, float h, inout Symmetric to) {
#define ADD_VOLUME(corner)                                                                                  \
  {                                                                                                         \
    bool exists;                                                                                            \
    uint cell = cellAt(slot, corner, exists);                                                               \
    float curvature = exists ? max(cellTangent(0u, cell).w, 0.0f) : 0.0f;                                   \
    if (curvature > 0.0f) {                                                                                 \
      CellShape shape = cellShape(cellTangent(0u, cell).xyz, cellTangent(1u, cell).xyz, cellTangent(2u, cell).xyz); \
      vec3 s = vec3(corner);                                                                                \
      addSquare((0.25f / h * sqrt(curvature)) * (s.x * shape.bc + s.y * shape.ca + s.z * shape.ab), to);     \
    }                                                                                                       \
  }
  FOR_EACH_CELL(ADD_VOLUME)
}
#endif

/// @return energy of the springs that the node owns [J]
double linearise(uint slot) {
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec3 u = ofStep(kStepPlace, slot), v = ofStep(kStepSpeed, slot), force = vec3(0.0f);
  float own = nodeMass(slot, bits, body) * (inertia + body.drag_per_s * rate), energy = 0.0f;
  Symmetric block = {own, 0.0f, 0.0f, own, 0.0f, own};
#ifdef DASHPOT
#define DASHPOT_OF(k) ((k) * body.dashpot_s)
#else
#define DASHPOT_OF(k) 0.0f
#endif
#define VISIT_LINK                                                                                   \
  Spring spring_now = springBetween(d, l0, prestrain, ofStep(kStepPlace, n) - u);                    \
  float across = spring_now.extension > 0.0f ? spring_now.extension / (l0 + spring_now.extension) : 0.0f; \
  float c = DASHPOT_OF(k);                                                                           \
  force += (k * spring_now.extension + c * dot(ofStep(kStepSpeed, n) - v, spring_now.direction)) * spring_now.direction; \
  vec3 s = sqrt(k * (1.0f - across) + c * rate) * spring_now.direction;                              \
  float t = k * across;                                                                              \
  addSquare(s, block);                                                                               \
  addIdentity(t, block);                                                                             \
  if (counted) {                                                                                     \
    tangents[(spring >> 1) * slot_count + slot] = packTangent(s, t);                                      \
    energy += 0.5f * k * spring_now.extension * spring_now.extension;                                \
  }
#define LINK(of_spring, offset)                      \
  {                                                  \
    const uint spring = of_spring;                   \
    LATTICE_LINK(spring, offset)                     \
  }
  FOR_EACH_SPRING(LINK)
#undef VISIT_LINK
#ifdef VOLUME
  force += xyz(volumeForce(slot));
  addVolumes(slot, body.origin_spacing.w, block);
#endif
  setOfStep(kStepForce, slot, force);
  storeInverse(block, slot, own, movable(slot));
  return double(energy);
}

void main() {
  uint i = globalIndex();
  double energy = i < active_count ? linearise(active_nodes[i]) : 0.0LF;
  sumUp(0u, dvec4(energy, 0.0LF, 0.0LF, 0.0LF));
}
