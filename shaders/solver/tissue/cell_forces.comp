// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// cell_forces.comp - forces of cells that obey a law on their corners.   Owner: solver/gpu/forces/cell_pass.h   physics.md 1
// in  displacement, nodes, rows     out  cell forces [kCellVectors * slots], wall pulls
// Feature CUT removes the cells that lost a spring instead. AWAKE: only cells next to awake bricks. WALLS: cells in thin walls
// also write their derivatives by rows of nodes, which row_forces.comp then gathers.
#ifndef __cplusplus
#define MAKES_CELL_FORCES
#endif
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/corners.glsl"

#ifndef __cplusplus
#ifdef AWAKE
layout(std430, binding = kBindAwakeCells) readonly buffer AwakeCellsBuffer {
  uvec3 cell_groups;
  uint cell_count;
  uvec4 cell_counts;
  uint cells[];
};
#else
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
uniform uint cell_count;
#endif
#endif

#ifdef CUT
#ifndef __cplusplus
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
#endif

/// Returns whether one of the cell's 24 springs, seen from a corner, has been cut.
bool torn(uint slot, uint c) {
  NodeBits bits = nodes[cornerSlot(slot, c)];
  if ((bits.lo & kSeveredBit) == 0u) return false;
  ivec3 at = ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u);
  bool lost = false;
#define LOST(spring, offset)                                                                        \
  {                                                                                                 \
    ivec3 to = at + offset;                                                                         \
    lost = lost || (all(greaterThanEqual(to, ivec3(0))) && all(lessThanEqual(to, ivec3(1))) && springCount(bits, spring) == 0u); \
  }
  FOR_EACH_SPRING(LOST)
  return lost;
}

void main() {
  uint i = globalIndex();
  if (i >= cell_count) return;
  uint slot = cells[i];
  if ((nodes[slot].lo & kCellBit) == 0u) return;
  bool lost = false;
  for (uint c = 0u; c < 8u; ++c) lost = lost || torn(slot, c);
  if (lost) nodes[slot].lo &= ~kCellBit;
}
#else
#ifndef __cplusplus
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
#endif

vec3 u(uint slot) { return xyz(stateAt(displacement, int(slot))); }
#include "solver/tissue/broken_cell.glsl"

#ifdef WALLS
#include "solver/tissue/rows.glsl"
layout(std430, binding = kBindWallPulls) writeonly buffer WallPullsBuffer { vec4 wall_pulls_out[]; };

/// For a cell that is no longer whole.
void leaveNoRows(uint slot) {
  for (uint i = 0u; i < kWallVectors; ++i) wall_pulls_out[inPlanes(slot, i, kWallVectors)] = vec4(0.0f);
}

void leaveRows(uint slot, CellRows by) {
  for (uint i = 0u; i < 3u; ++i) wall_pulls_out[inPlanes(slot, i, kWallVectors)] = vec4(by.second[i], 0.0f);
  for (uint i = 0u; i < 6u; ++i) wall_pulls_out[inPlanes(slot, 3u + i, kWallVectors)] = vec4(by.varied[i], 0.0f);
}
#endif

/// Writes the forces of a cell of a body with a law, at the predicted positions of its nodes, which damps (physics.md 2).
/// @param whole  it has all springs
void leaveLawForces(uint slot, BodyParams body, bool whole) {
  float h = body.origin_spacing.w;
  vec3 at[8];
  for (uint c = 0u; c < 8u; ++c) {
    uint corner = cornerSlot(slot, c);
#ifdef DASHPOT
    at[c] = u(corner) + body.dashpot_s * xyz(stateAt(velocity, int(corner)));
#else
    at[c] = u(corner);
#endif
  }
  CellMoments moments = cellMoments(slot);
  if (!whole) {
    BrokenCell cell = brokenCell(slot, at, h, cellRigidity(slot, body), moments);
    for (uint c = 0u; c < 8u; ++c) cell_forces_out[cellVector(slot, c)] = vec4(cell.force[c], 0.0f);
#ifdef WALLS
    if (moments.wall.w > 0.0f) leaveNoRows(slot);
#endif
    return;
  }
  CellModes q = cellMotion(at, h);
#ifdef WALLS
  if (moments.wall.w > 0.0f) q.rows = cellRows(slot);
#endif
  CellForces f = lawForces(q, body, cellBulk(slot, body), cellRigidity(slot, body), moments);
#ifdef WALLS
  if (moments.wall.w > 0.0f) leaveRows(slot, f.rows);
#endif
  for (uint c = 0u; c < 8u; c += 2u) {  // the corners at x = -1 and 1
    vec3 s = cornerSide(c);
    vec3 even = s.y * f.b + s.z * f.c + (s.y * s.z) * f.hx;
    vec3 odd = f.a + s.y * f.hz + s.z * f.hy + (s.y * s.z) * f.hxyz;
    cell_forces_out[cellVector(slot, c)] = vec4(odd - even, 0.0f);
    cell_forces_out[cellVector(slot, c + 1u)] = vec4(-(even + odd), 0.0f);
  }
}

void main() {
  uint i = globalIndex();
  if (i >= cell_count) return;
  uint slot = cells[i];
  NodeBits bits = nodes[slot];
  if ((bits.lo & kLawCellBit) != 0u) leaveLawForces(slot, bodies[bodyOf(bits)], (bits.lo & kCellBit) != 0u);
}
#endif
