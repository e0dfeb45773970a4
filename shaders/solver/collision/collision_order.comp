// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// collision_order.comp - step 4 of the search: sorts each bucket by slot.
// Owner: solver/gpu/contact/collision_pass.h   physics.md 8
// in  buckets, unsorted     out  entries, entries_before
#include "solver/collision/collision_search.glsl"

void main() {
  uint e = globalIndex();
  if (e >= buckets[3u * bucket_count]) return;
  uint slot = unsorted[e];
  vec3 x = positionOf(slot);
  uint b = bucketOf(x), first = buckets[3u * b + 1u], position = first;
  for (uint k = first; k < first + buckets[3u * b]; ++k) position += unsorted[k] < slot ? 1u : 0u;
  uvec3 bits = floatBitsToUint(x);
  entries[position] = uvec4(bits, slot);
  entries_before[position] = vec4(positionBefore(slot), 0.0);
}
