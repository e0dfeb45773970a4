// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_count.comp - step 1 of the search: counts the nodes per bucket.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// out  buckets
#include "solver/collision/collision_search.glsl"

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 x = positionOf(slot);
  if (collides(slot, nodes[slot], x)) atomicAdd(buckets[3u * bucketOf(x)], 1u);
}
