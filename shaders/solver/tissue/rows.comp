// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// rows.comp - second differences of rows of nodes in thin walls.   Owner: solver/gpu/forces/row_pass.h   physics.md 1, Thin walls
// in  displacement, velocity, nodes     out  rows [kRowVectors * slots]
// Features: WALLS, DASHPOT (of predicted positions, as in cell_forces.comp), AWAKE (wall_nodes.glsl).
#define MAKES_CELL_FORCES
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/wall_nodes.glsl"

layout(std430, binding = kBindRows) writeonly buffer RowsOut { vec4 rows_out[]; };

/// Returns the displacement of a node over h, predicted with a dashpot.
vec3 position(uint slot, BodyParams body) {
  vec3 u = xyz(stateAt(displacement, int(slot)));
#ifdef DASHPOT
  u += body.dashpot_s * xyz(stateAt(velocity, int(slot)));
#endif
  return u / body.origin_spacing.w;
}

/// Returns the second difference at a node within a row, with w = 1; elsewhere 0.
vec4 differenceAt(uint slot, NodeBits bits, uint axis, BodyParams body) {
  if (!isWithinRow(bits, axis)) return vec4(0.0f);
  vec3 here = position(slot, body);
  vec3 below = position(besideInRow(slot, axis, -1), body) - here, above = position(besideInRow(slot, axis, 1), body) - here;
  return vec4(below + above, 1.0f);
}

/// Returns the second difference at a node; the end of a row uses that of the node next to it.
vec4 rowAt(uint slot, NodeBits bits, uint axis, BodyParams body) {
  if (isWithinRow(bits, axis)) return differenceAt(slot, bits, axis, body);
  for (int side = -1; side < 2; side += 2) {
    if (springCount(bits, 2u * axis + (side < 0 ? 1u : 0u)) == 0u) continue;
    uint beside = besideInRow(slot, axis, side);
    return differenceAt(beside, nodes[beside], axis, body);
  }
  return vec4(0.0f);
}

void main() {
  uint i = globalIndex();
  if (i >= wall_node_count) return;
  uint slot = wall_nodes[i];
  if (!isWanted(slot)) return;
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  for (uint axis = 0u; axis < 3u; ++axis) rows_out[inPlanes(slot, axis, kRowVectors)] = rowAt(slot, bits, axis, body);
}
