// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Which bricks are stepped: of shaders/solver/step/awake_bricks.comp and its owner.
#ifndef VISCERA_LAYOUT_AWAKE_BRICKS_H
#define VISCERA_LAYOUT_AWAKE_BRICKS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kNeverMoves = 0u;   // SleepingBrick::kind: no node that may move
const uint kMayMove = 1u;
const uint kNeverSleeps = 2u;  // explicit connections

// A brick of 4x4x4 nodes as sleep has it.
struct SleepingBrick {
  float quiet_s;      // for so long all its nodes have been slow
  float farthest_m;   // largest |u| when it fell asleep
  uint kind;
  uint awake;         // 1 or 0
  uint wanted;        // number of the last look at which it, or one beside it, was restless
  uint first_node;    // in the list of active nodes
  uint node_count;
  uint first_cell;    // in the list of cells
  uint cell_count;
  uint cells_listed;  // 1: its cells are, as it or one around it is awake; only with cells in thin walls
  uint pad[2];
};

// In front of a list of nodes or cells: how many, and in groups as glDispatchComputeIndirect takes them.
struct AwakeList {
  uint groups_x;
  uint groups_y;
  uint groups_z;      // 1
  uint count;
  uint bricks;        // awake ones but those that never sleep; this and below: nodes only
  uint farthest_bits; // float bits of the largest farthest_m of those asleep
  uint springs_cut;   // TickStats::springs_cut when it was last looked at
  uint pad;
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
