// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_place.comp - the search, second: where each bucket begins.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in, out  buckets     A bucket of more than most_in_bucket nodes is left empty: what collapsed into one place would otherwise be compared
// each with all in one dispatch. A node in it touches nothing until it has spread; how many that are is noted.
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
