// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_exchange.comp - GW's search, then: a step of a bitonic sort by cell.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in, out  items
#include "solver/collision/collision_search.glsl"

uniform uint run;   // length of runs that are sorted after this pass over the distances
uniform uint away;  // distance of the two that are compared

void main() {
  uint i = globalIndex();
  if (i >= partitions * sorted_count / 2u) return;
  uint low = 2u * i - (i & (away - 1u)), high = low + away;
  uvec2 a = items[low], b = items[high];
  bool greater = a.x > b.x || (a.x == b.x && a.y > b.y);
  bool rising = ((low & (sorted_count - 1u)) & run) == 0u;
  if (greater != rising) return;
  items[low] = b;
  items[high] = a;
}
