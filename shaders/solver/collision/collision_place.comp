// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_place.comp - step 2 of the search: the start of each bucket.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in, out  buckets     A bucket of more than most_in_bucket nodes is left empty: nodes collapsed into one place would otherwise
// be compared pairwise in one dispatch. They touch nothing until they have spread; their number is counted.
#include "solver/collision/collision_search.glsl"

void main() {
  uint b = globalIndex();
  if (b >= bucket_count) return;
  uint count = buckets[3u * b];
  if (count > most_in_bucket) {
    atomicAdd(buckets[3u * bucket_count + 1u], count);
    buckets[3u * b] = 0u;
  } else if (count != 0u) buckets[3u * b + 1u] = atomicAdd(buckets[3u * bucket_count], count);
}
