// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Search for nodes that may touch: a hashed uniform grid by counting sort.
// Uses integer atomics only. The position of a bucket depends on their order; its content and the order in it do not.
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
