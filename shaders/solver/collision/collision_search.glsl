// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How nodes are looked up that may touch: in a hashed uniform grid by counting sort; or, STAGGERED, by GW's search.
// Integer atomics only; where a bucket lies depends on their order, what is in it and in which order does not.
// in  displacement, velocity [slots] after the integrator; displacement before it in the other buffer
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/collision/collision.glsl"

#ifndef STAGGERED
#ifndef __cplusplus
uniform uint most_in_bucket;
#endif

uint bucketOf(vec3 x) { return hashOf(cellOf(x, 0.0f)) & (bucket_count - 1u); }

Entry entryAt(uint e) {
  uvec4 at = entries[e];
  Entry entry = {at.w, uintBitsToFloat(uvec3(at.x, at.y, at.z)), xyz(entries_before[e])};
  return entry;
}
#else
/// Partitions are shifted along the diagonal, by equal parts of a cell.
ivec3 cellIn(uint part, vec3 x) { return cellOf(x, float(part) / float(partitions)); }

Entry entryOf(uint slot) {
  Entry entry = {slot, positionOf(slot), positionBefore(slot)};
  return entry;
}

bool near(uint part, uint slot_a, vec3 a, uint slot_b, vec3 b) {
  if (cellIn(part, a) != cellIn(part, b)) return false;
  int away = int(ranks[part * slot_count + slot_a]) - int(ranks[part * slot_count + slot_b]);
  return abs(away) <= int(window);
}

/// A pair that several partitions show counts in the first.
bool foundBefore(uint part, Entry a, Entry b) {
  for (uint p = 0u; p < part; ++p) {
    if (near(p, a.slot, a.x, b.slot, b.x)) return true;
  }
  return false;
}
#endif
