// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The ring of triangles around a vertex of a network's skin. After lattice.glsl (feature NETWORK) and skin_basis.glsl.
#ifndef __cplusplus
uniform uint count;
uniform uint followed_revision;  // what moved no later is in place; 0: nothing is
layout(std430, binding = kBindStaleBricks) readonly buffer StaleBricksBuffer { uint stale_bricks[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
layout(std430, binding = kBindRingVertices) readonly buffer RingVerticesBuffer { RingVertex ring_vertices[]; };
layout(std430, binding = kBindRings) readonly buffer RingsBuffer { RingTriangle rings[]; };
layout(std430, binding = kBindSkinAlive) readonly buffer AliveBuffer { uint alive[]; };
#endif

bool hasMoved(uint slot) { return stale_bricks[slot >> 6] > followed_revision; }

/// A node moved that the vertex's place or normal depends on: it may lie in any brick.
bool isStale(RingVertex v) {
  if (followed_revision == 0u || hasMoved(v.slot)) return true;
  for (uint i = v.ring_begin; i < v.ring_end; ++i) {
    if (hasMoved(rings[i].slot1) || hasMoved(rings[i].slot2)) return true;
  }
  return false;
}

/// Its corners still hang together.
bool isWhole(RingTriangle t) { return alive[t.triangle] == kShownWhole; }

vec3 restEdge(uint slot, uint other) { return tabulatedRest(other) - tabulatedRest(slot); }

/// Rest offset plus difference of displacements: exact at rest, wherever the body is.
vec3 edge(uint slot, uint other) {
  return restEdge(slot, other) + (xyz(displacement[other]) - xyz(displacement[slot]));
}
