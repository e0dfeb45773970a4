// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Selection of the bricks that are stepped, shared by shaders/solver/step/awake_bricks.comp and its owner.
#ifndef VISCERA_LAYOUT_AWAKE_BRICKS_H
#define VISCERA_LAYOUT_AWAKE_BRICKS_H
#include "viscera/layout/limits.h"
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kNeverMoves = 0u;   // SleepingBrick::kind: no node of the brick can move
const uint kMayMove = 1u;
const uint kNeverSleeps = 2u;  // explicit connections

const uint kShaftBoxes = 4u;  // boxes along a shaft: one of all of a slanting shaft would hold much of an organ
const uint kMostToolBoxes = kMaxStyluses * (1u + kShaftBoxes);  // boxes of all tools in a tick

// State of sleep of a brick of 4x4x4 nodes.
struct SleepingBrick {
  float quiet_s;      // time for which all nodes of the brick have been slow [s]
  float farthest_m;   // largest |u| when it fell asleep [m]
  uint kind;
  uint awake;         // 1 or 0
  uint wanted;        // number of the last check in which the brick or a neighbour was restless
  uint first_node;    // index into the list of active nodes
  uint node_count;
  uint first_cell;    // index into the list of cells
  uint cell_count;
  uint cells_listed;  // 1: its cells are listed, as it or a neighbour is awake; only with cells in thin walls
  uint pad[2];
};

// Header of a list of nodes or cells: the count, and the group counts for glDispatchComputeIndirect.
struct AwakeList {
  uint groups_x;
  uint groups_y;
  uint groups_z;      // 1
  uint count;
  uint bricks;        // number of awake bricks without those that never sleep; this and what follows: lists of nodes only
  uint farthest_bits; // float bits of the largest farthest_m of the sleeping bricks
  uint springs_cut;   // TickStats::springs_cut at the last check
  uint pad;
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
