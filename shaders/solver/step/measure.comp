// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// measure.comp - the state of the tissue at the end of a tick.   Owner: solver/gpu/measure_pass.h   physics.md 3
// in  displacement, velocity, nodes, cell forces' cells     out  stats; energy of every node, summed with feature FOLD
// Integer atomics only: their result does not depend on the order. Energies are summed in a fixed tree of runs of kRun terms.
#include "layout.h"
#include "solver/tissue/lattice.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };
layout(std430, binding = kBindPartials) buffer PartialsBuffer { vec2 energies[]; };  // kinetic, elastic [J]
uniform uint count;  // active nodes; FOLD: terms of this level
#endif

#ifdef FOLD
const uint kRun = 64u;
uniform uint input_first;
uniform uint output_first;
uniform uint last_level;

void main() {
  uint run = globalIndex();
  if (run * kRun >= count) return;
  vec2 sum = vec2(0.0);
  uint end = min((run + 1u) * kRun, count);
  for (uint i = run * kRun; i < end; ++i) sum += energies[input_first + i];
  energies[output_first + run] = sum;
  if (last_level == 0u) return;
  stats.kinetic_j = sum.x;
  stats.elastic_j = sum.y;
}
#else
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/corners.glsl"
#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
#endif
#ifdef LAW
#include "solver/tissue/broken_cell.glsl"
#endif
#ifdef WALLS
#include "solver/tissue/rows.glsl"
#endif

/// Compilers drop isnan(); the bits are reliable (physics.md 2).
bool finite(vec3 v) {
  uvec3 bits = floatBitsToUint(v) & 0x7f800000u;
  return all(notEqual(bits, uvec3(0x7f800000u)));
}

vec3 u(uint slot) { return xyz(stateAt(displacement, int(slot))); }

/// Returns V/V0 - 1 of a cell. @param n  displacements of its corners, bit per axis, x lowest [m]
float dilation(vec3 n[8], float h) {
  CellModes q = cellMotion(n, h);
  vec3 da = q.da, db = q.db, dc = q.dc;
  float minors = (da.x * db.y - da.y * db.x) + (da.x * dc.z - da.z * dc.x) + (db.y * dc.z - db.z * dc.y);
  return (da.x + db.y + dc.z) + (minors + dot(da, cross(db, dc)));
}

#ifdef LAW
/// Returns the stiffness with which the cells around a node at rest resist a change of volume in addition to its springs [N/m].
float volumeStiffness(uint slot, BodyParams body) {
  float sum = 0.0f;
#define ADD_BULK(corner)                                                                                             \
  {                                                                                                                  \
    bool exists;                                                                                                     \
    uint cell = cellAt(slot, corner, exists);                                                                        \
    if (exists && (nodes[cell].lo & kCellBit) != 0u) sum += max(0.0f, cellBulk(cell, body));                           \
  }
  FOR_EACH_CELL(ADD_BULK)
  return 1.5f * sum / (body.origin_spacing.w * body.origin_spacing.w);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 near = u(slot), v = xyz(stateAt(velocity, int(slot)));
  energies[i] = vec2(0.0f);
  if (!finite(near) || !finite(v)) {
    atomicAdd(stats.nonfinite, 1u);
    return;
  }
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  float stretch = 0.0f, elastic = 0.0f, stiffness = 0.0f;
  uint collapsed = 0u;
#ifdef LAW
  bool of_law = body.law != kLawSprings;  // the energy of its springs is included in that of its cells
#else
  const bool of_law = false;
#endif
#define VISIT_LINK                                                                     \
  stiffness += k;                                                                      \
  vec3 far = u(n);                                                                     \
  if (counted && finite(far)) {                                                        \
    float extension = springBetween(d, l0, prestrain, far - near).extension;           \
    if (l0 > 0.0f) stretch = max(stretch, abs(extension) / l0);                         \
    if (extension < (kCollapsed - 1.0f) * l0) ++collapsed;                              \
    if (!of_law) elastic += 0.5f * k * extension * extension;                           \
  }
  FOR_EACH_LINK
#undef VISIT_LINK
  stiffness *= 2.0f;
#ifdef LAW
  stiffness += volumeStiffness(slot, body);
#endif
  if ((bits.lo & kCellBit) != 0u) {
    float h = body.origin_spacing.w;
    vec3 at[8];
    for (uint c = 0u; c < 8u; ++c) at[c] = u(cornerSlot(slot, c));
    float e = dilation(at, h);
#ifdef LAW
    if ((bits.lo & kLawCellBit) != 0u) {
      float bulk = cellBulk(slot, body), rigidity = cellRigidity(slot, body);
      CellModes q = cellMotion(at, h);
      CellMoments moments = cellMoments(slot);
#ifdef WALLS
      if (moments.wall.w > 0.0f) q.rows = cellRows(slot);
#endif
      elastic += lawPull(q, moments, rigidity, bulk, body.stiffening).energy;
      uint stiffening = floatBitsToUint(lawStiffening(q, moments, bulk / rigidity, body.stiffening));
      if (stiffening > stats.max_stiffening_bits) atomicMax(stats.max_stiffening_bits, stiffening);
    }
#endif
    if (e < -1.0f && (bits.lo & kSeveredBit) == 0u) atomicAdd(stats.inverted, 1u);
  }
#ifdef LAW
  else if ((bits.lo & kLawCellBit) != 0u) {
    vec3 at[8];
    for (uint c = 0u; c < 8u; ++c) at[c] = u(cornerSlot(slot, c));
    elastic += brokenCell(slot, at, body.origin_spacing.w, cellRigidity(slot, body), cellMoments(slot)).energy;
  }
#endif
  energies[i] = vec2(0.5f * mass * dot(v, v), elastic);
  // Positive floats order like their bits. The read before the atomic only saves work: the maximum is the same.
  uint stretch_bits = floatBitsToUint(stretch), speed_bits = floatBitsToUint(length(v)), rate_bits = floatBitsToUint(stiffness / mass);
  if (stretch_bits > stats.max_stretch_bits) atomicMax(stats.max_stretch_bits, stretch_bits);
  if (speed_bits > stats.max_speed_bits) atomicMax(stats.max_speed_bits, speed_bits);
  if ((bits.lo & kFixedBit) == 0u && rate_bits > stats.max_rate_bits) atomicMax(stats.max_rate_bits, rate_bits);
  if (collapsed != 0u) atomicAdd(stats.collapsed, collapsed);
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) atomicAdd(stats.grabbed[held_by - 1u], 1u);
}
#endif
