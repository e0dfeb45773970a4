// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// row_forces.comp - forces of cells in thin walls on rows of nodes, for their nodes to gather.   Owner: solver/gpu/forces/row_pass.h
// physics.md 1, Thin walls
// in  wall pulls, nodes     out  cell forces from kCellVectors on: the force on the second difference of the row through a node [N]
// Features: WALLS, AWAKE (wall_nodes.glsl).
#define MAKES_CELL_FORCES
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/wall_nodes.glsl"

#ifdef LOADS
layout(std430, binding = kBindWallPulls) restrict readonly buffer WallPullsIn { vec4 wall_pulls[]; };  // of cell_forces.comp
#else
layout(binding = kUnitWallPulls) uniform samplerBuffer wall_pulls;  // the same
#endif
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };

vec3 wallPull(uint cell, uint vector) { return xyz(stateAt(wall_pulls, int(inPlanes(cell, vector, kWallVectors)))); }

/// Returns the derivative of the energy of the cells around a node by the node's difference along an axis [J].
vec3 pullAt(uint slot, uint axis) {
  uint next = axis == 2u ? 0u : axis + 1u, last = axis == 0u ? 2u : axis - 1u;
  vec3 sum = vec3(0.0f);
#define ADD_WALL(corner)                                                                               \
  {                                                                                                    \
    bool exists;                                                                                       \
    uint cell = cellAt(slot, corner, exists);                                                          \
    if (exists) {                                                                                      \
      vec3 side = 0.25f * vec3(corner);                                                                \
      sum += 0.125f * wallPull(cell, axis) + side[next] * wallPull(cell, 3u + 2u * axis) +             \
             side[last] * wallPull(cell, 4u + 2u * axis);                                              \
    }                                                                                                  \
  }
  FOR_EACH_CELL(ADD_WALL)
  return sum;
}

/// Returns the same by the node's own second difference, which adjacent ends of the row use too.
vec3 pullOfRow(uint slot, NodeBits bits, uint axis) {
  if (!isWithinRow(bits, axis)) return vec3(0.0f);
  vec3 sum = pullAt(slot, axis);
  for (int side = -1; side < 2; side += 2) {
    uint beside = besideInRow(slot, axis, side);
    if (!isWithinRow(nodes[beside], axis)) sum += pullAt(beside, axis);
  }
  return sum;
}

void main() {
  uint i = globalIndex();
  if (i >= wall_node_count) return;
  uint slot = wall_nodes[i];
  if (!isWanted(slot)) return;
  NodeBits bits = nodes[slot];
  float h = bodies[bodyOf(bits)].origin_spacing.w;
  for (uint axis = 0u; axis < 3u; ++axis) {
    cell_forces_out[cellVector(slot, kCellVectors + axis)] = vec4(pullOfRow(slot, bits, axis) / h, 0.0f);
  }
}
