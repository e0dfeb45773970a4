// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The ring of triangles around a vertex of a network. Include it after lattice.glsl (feature NETWORK) and
// skin_basis.glsl.
#ifndef __cplusplus
uniform uint count;
uniform uint followed_revision;  // vertices that have not moved after it are up to date; 0: none are
layout(std430, binding = kBindStaleBricks) readonly buffer StaleBricksBuffer { uint stale_bricks[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
layout(std430, binding = kBindRingVertices) readonly buffer RingVerticesBuffer { RingVertex ring_vertices[]; };
layout(std430, binding = kBindRings) readonly buffer RingsBuffer { RingTriangle rings[]; };
layout(std430, binding = kBindSkinAlive) readonly buffer AliveBuffer { uint alive[]; };
#endif

bool hasMoved(uint slot) { return stale_bricks[slot >> 6] > followed_revision; }

/// Returns whether a node has moved that the vertex's place or normal depends on; it may be in any brick.
bool isStale(RingVertex v) {
  if (followed_revision == 0u || hasMoved(v.slot)) return true;
  for (uint i = v.ring_begin; i < v.ring_end; ++i) {
    if (hasMoved(rings[i].slot1) || hasMoved(rings[i].slot2)) return true;
  }
  return false;
}

/// Returns whether its corners are still connected.
bool isWhole(RingTriangle t) { return alive[t.triangle] == kShownWhole; }

vec3 restEdge(uint slot, uint other) { return tabulatedRest(other) - tabulatedRest(slot); }

/// Returns an edge as rest offset plus difference of displacements: exact at rest, wherever the body is.
vec3 edge(uint slot, uint other) {
  return restEdge(slot, other) + (xyz(displacement[other]) - xyz(displacement[slot]));
}
