// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How nodes are looked up that may touch: in a hashed uniform grid by counting sort.
// Integer atomics only; where a bucket lies depends on their order, what is in it and in which order does not.
// in  displacement, velocity [slots] after the integrator; displacement before it in the other buffer
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/collision/collision.glsl"

#ifndef __cplusplus
uniform uint most_in_bucket;
#endif

uint bucketOf(vec3 x) { return hashOf(cellOf(x)) & (bucket_count - 1u); }

Entry entryAt(uint e) {
  uvec4 at = entries[e];
  Entry entry = {at.w, uintBitsToFloat(uvec3(at.x, at.y, at.z)), xyz(entries_before[e])};
  return entry;
}
