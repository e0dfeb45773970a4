// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_scatter.comp - step 3 of the search: puts the nodes into their buckets.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in  buckets     out  unsorted; zero corrections of nodes in a crowd
#include "solver/collision/collision_search.glsl"

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 x = positionOf(slot);
  if (!collides(slot, nodes[slot], x)) return;
  uint b = bucketOf(x);
  if (buckets[3u * b] == 0u) {  // a crowd (collision_place.comp)
    contacts[slot] = corrections[2u * slot] = corrections[2u * slot + 1u] = vec4(0.0);
    return;
  }
  unsorted[buckets[3u * b + 1u] + atomicAdd(buckets[3u * b + 2u], 1u)] = slot;
}
