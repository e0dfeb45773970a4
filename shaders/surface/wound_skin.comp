// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// wound_skin.comp - the vertices that cuts have added to the skins of bodies of tetrahedra: where three nodes of one side carry them,
// turned with their triangle, but not stretched (docs/wounds.md 4).   Owner: surface/network_surface.h
// in  skin[first_vertex + count], displacement[slots] m, rest[slots] m
// in, out  positions[3 * vertices] m, normals[vertices] packed: those of the skins' own vertices are in place
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // before globalIndex(), which asks for it
#endif
#include "solver/tissue/lattice.glsl"
#include "pack.glsl"
#include "skin_basis.glsl"
#include "ring.glsl"

#ifndef __cplusplus
uniform uint first_vertex;
layout(std430, binding = kBindSkinBindings) readonly buffer SkinBuffer { SkinBinding skin[]; };
layout(std430, binding = kBindSkinPositions) writeonly buffer PositionsBuffer { float positions[]; };
layout(std430, binding = kBindSkinNormals) buffer NormalsBuffer { uint normals[]; };
#endif

/// A unit vector at right angles to a unit vector.
vec3 besides(vec3 axis) {
  vec3 along = abs(axis.x) < 0.5f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
  return direction(cross(axis, along), along);
}

void main() {
  if (globalIndex() >= count) return;
  uint vertex = first_vertex + globalIndex();
  SkinBinding s = skin[vertex];
  if ((s.springs & kOneToOneBit) == 0u) return;  // a lattice's
  vec3 rest1 = restEdge(s.slot0, s.slot1), rest2 = restEdge(s.slot0, s.slot2);
  vec3 edge1 = edge(s.slot0, s.slot1), edge2 = edge(s.slot0, s.slot2);
  vec3 along = direction(rest1, vec3(1.0f, 0.0f, 0.0f));
  Basis rest = triangleBasis(rest1, rest2, along, besides(along));
  Basis now = triangleBasis(edge1, edge2, rest.t, rest.b);
  vec3 d = xyz(s.offset_constant), n = xyz(s.normal_constant);
  vec3 offset = inSpace(now, vec3(dot(d, rest.t), dot(d, rest.n), dot(d, rest.b)));
  vec3 position = tabulatedRest(s.slot0) + (xyz(displacement[s.slot0]) + (s.weights.y * edge1 + s.weights.z * edge2 + offset));
  positions[3u * vertex] = position.x;
  positions[3u * vertex + 1u] = position.y;
  positions[3u * vertex + 2u] = position.z;
  uint copied = s.springs & kCopiedNormalMask;
  vec3 normal = direction(inSpace(now, vec3(dot(n, rest.t), dot(n, rest.n), dot(n, rest.b))), n);
  normals[vertex] = copied != 0u ? normals[copied - 1u] : packNormal(normal);
}
