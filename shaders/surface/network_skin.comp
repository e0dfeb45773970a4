// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// network_skin.comp - vertices and normals of networks' meshes from their nodes, one to one (EGVE 3.2).
// Owner: surface/network_surface.h   physics.md 4
// in  ring_vertices[count], rings[], displacement[slots] m, rest[slots] m, alive[triangles], stale_bricks[bricks]
// out  positions[3 * vertices] m, normals[vertices] packed
// A normal is the mean of the whole triangles around the vertex, weighted by area; without one, the normal at rest.
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#endif
#include "solver/tissue/lattice.glsl"
#include "pack.glsl"
#include "skin_basis.glsl"
#include "ring.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindSkinPositions) writeonly buffer PositionsBuffer { float positions[]; };
layout(std430, binding = kBindSkinNormals) writeonly buffer NormalsBuffer { uint normals[]; };
#endif

vec3 ringNormal(RingVertex v) {
  vec3 sum = vec3(0.0f);
  for (uint i = v.ring_begin; i < v.ring_end; ++i) {
    RingTriangle t = rings[i];
    vec3 normal = cross(edge(v.slot, t.slot1), edge(v.slot, t.slot2));
    sum += isWhole(t) ? normal : vec3(0.0f);  // a branch around the cross product costs llvmpipe three times as much
  }
  vec3 normal = direction(sum, xyz(v.rest_normal));
  return dot(normal, normal) < 2.0f ? normal : xyz(v.rest_normal);  // if the sum is not a number
}

void main() {
  uint index = globalIndex();
  if (index >= count) return;
  RingVertex v = ring_vertices[index];
  if (!isStale(v)) return;
  vec3 position = tabulatedRest(v.slot) + xyz(displacement[v.slot]);
  positions[3u * v.vertex] = position.x;
  positions[3u * v.vertex + 1u] = position.y;
  positions[3u * v.vertex + 2u] = position.z;
  normals[v.vertex] = packNormal(ringNormal(v));
}
