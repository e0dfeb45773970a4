// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// split_edges.comp - the two vertices of an edge of a network's mesh that a blade has crossed: one on either side, each
// carried by the node on its side as if the piece between them were still there.   Owner: surface/network_surface.h
// in  split_edges[count], spring_cut[springs], ring_vertices[], rings[], displacement[slots] m, rest[slots] m
// in, out  positions[3 * vertices] m, normals[vertices] packed: those of the nodes must be up to date
// An intact edge has both in its middle; they are not visible, so they are placed once. After that the kernel runs over
// the crossed edges alone (crossed_edges.comp): work is proportional to the length of the cut.
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#endif
#include "solver/tissue/lattice.glsl"
#include "skin_basis.glsl"
#include "ring.glsl"

#ifndef __cplusplus
uniform uint placed;  // vertices of intact edges are placed already: only crossed ones
layout(std430, binding = kBindSplitEdges) readonly buffer SplitEdgesBuffer { SplitEdge split_edges[]; };
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
layout(std430, binding = kBindCrossedEdges) readonly buffer CrossedEdgesBuffer { uint crossed_edges[]; };
layout(std430, binding = kBindSkinPositions) writeonly buffer PositionsBuffer { float positions[]; };
layout(std430, binding = kBindSkinNormals) buffer NormalsBuffer { uint normals[]; };
#endif

const float kAsNear = 1e-5f;  // cosines closer than this are equal: rounding must not choose between two triangles

/// Returns the rest offset d turned like the nearest triangle, but not stretched.
vec3 turned(RingVertex v, vec3 d) {
  float nearest = -2.0f;
  uint best = v.ring_end;
  for (uint i = v.ring_begin; i < v.ring_end; ++i) {
    if (!isWhole(rings[i])) continue;
    vec3 middle = restEdge(v.slot, rings[i].slot1) + restEdge(v.slot, rings[i].slot2);
    float cosine = dot(direction(middle, vec3(0.0f)), direction(d, vec3(0.0f)));
    if (cosine > nearest + kAsNear) {
      nearest = cosine;
      best = i;
    }
  }
  if (best == v.ring_end) return d;
  uint slot1 = rings[best].slot1, slot2 = rings[best].slot2;
  Basis rest;
  rest.t = direction(restEdge(v.slot, slot1), vec3(0.0f));
  rest.n = direction(cross(rest.t, restEdge(v.slot, slot2)), vec3(0.0f));
  if (dot(rest.n, rest.n) == 0.0f) return d;  // no area at rest, so nothing to turn with
  rest.b = cross(rest.n, rest.t);
  Basis now = triangleBasis(edge(v.slot, slot1), edge(v.slot, slot2), rest.t, rest.b);
  return inSpace(now, vec3(dot(d, rest.t), dot(d, rest.n), dot(d, rest.b)));
}

void place(uint vertex, RingVertex v, vec3 d) {
  vec3 position = tabulatedRest(v.slot) + (xyz(displacement[v.slot]) + turned(v, d));
  positions[3u * vertex] = position.x;
  positions[3u * vertex + 1u] = position.y;
  positions[3u * vertex + 2u] = position.z;
  normals[vertex] = normals[v.vertex];
}

void main() {
  uint index = globalIndex();
  if (index >= (placed != 0u ? crossed_edges[3] : count)) return;
  SplitEdge e = split_edges[placed != 0u ? crossed_edges[4u + index] : index];
  float crossed = spring_cut[e.spring];
  RingVertex a = ring_vertices[e.a], b = ring_vertices[e.b];
  if (!isStale(a) && !isStale(b)) return;
  float share = crossed == 0.0f ? 0.5f : min(crossed, 1.0f);
  vec3 d = restEdge(a.slot, b.slot);
  place(e.vertex, a, share * d);
  place(e.vertex + 1u, b, (share - 1.0f) * d);
}
