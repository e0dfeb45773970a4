// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_place.comp - complete search, second: where each bucket begins.
// Owner: solver/gpu/collision_pass.h   physics.md 8
// in, out  buckets
#include "collision_search.glsl"

void main() {
  uint b = globalIndex();
  if (b >= bucket_count) return;
  uint count = buckets[3u * b];
  if (count != 0u) buckets[3u * b + 1u] = atomicAdd(buckets[3u * bucket_count], count);
}
