// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_rank.comp - GW's search, last: where each node ended up.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in  items     out  ranks [partitions * slots]
#include "solver/collision/collision_search.glsl"

void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count) return;
  uint slot = items[i].y;
  if (slot != 0xffffffffu) ranks[(i / sorted_count) * slot_count + slot] = i % sorted_count;
}
