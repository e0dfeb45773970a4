// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_list.comp - GW's search, first: keys of cells. Partitions of space, each shifted by a part of a cell.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// out  items [partitions * sorted]
#include "solver/collision/collision_search.glsl"

void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count) return;
  uint k = i % sorted_count;
  items[i] = uvec2(0xffffffffu);
  if (k >= active_count) return;
  uint slot = active_nodes[k];
  vec3 x = positionOf(slot);
  if (collides(slot, nodes[slot], x)) items[i] = uvec2(hashOf(cellIn(i / sorted_count, x)), slot);
}
