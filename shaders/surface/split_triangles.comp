// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// split_triangles.comp - shown pieces of a network's triangles that a blade has crossed.
// Owner: surface/network_surface.h   Must agree with appendShown (surface/visible_triangles.h).
// in  triangles[3 * triangles], split_triangles[count], spring_cut[springs], nodes[slots]
// out  alive[triangles], live[3 * (triangles + 2 count)]
// With one edge crossed the cut ends inside: the triangle stays. With two, the corner between them is separated from
// the other two. With three, every corner is separated, and the piece in the middle, without a node, is left out. So is
// a corner with a node without springs, and a triangle at a node that was erased (kErasedShare).
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#endif
#include "solver/tissue/lattice.glsl"

#ifndef __cplusplus
uniform uint count;
uniform uint triangle_count;  // of all bodies
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindSkinTriangles) readonly buffer TrianglesBuffer { uint triangles[]; };
layout(std430, binding = kBindSplitTriangles) readonly buffer SplitTrianglesBuffer { SplitTriangle split_triangles[]; };
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
layout(std430, binding = kBindSkinAlive) writeonly buffer AliveBuffer { uint alive[]; };
layout(std430, binding = kBindSkinLive) writeonly buffer LiveBuffer { uint live[]; };
#endif

float cutOf(uint spring) { return spring == kNoSpring ? 0.0 : spring_cut[spring]; }

/// Returns the corner, if its node still has springs.
uint cornerOf(SplitTriangle t, uint corner) {
  return (nodes[t.slots[corner]].lo & kValenceMask) != 0u ? kShownCorner << corner : 0u;
}

uint shownOf(SplitTriangle t) {
  float cut01 = cutOf(t.springs[0]), cut12 = cutOf(t.springs[1]), cut20 = cutOf(t.springs[2]);
  if (max(cut01, max(cut12, cut20)) >= kErasedShare) return 0u;
  uint cuts = uint(cut01 != 0.0f) + uint(cut12 != 0.0f) + uint(cut20 != 0.0f);
  if (cuts < 2u) return kShownWhole;
  if (cuts == 3u) return cornerOf(t, 0u) | cornerOf(t, 1u) | cornerOf(t, 2u);
  uint corner = cut12 == 0.0f ? 0u : cut20 == 0.0f ? 1u : 2u;  // the one opposite the intact edge
  return cornerOf(t, corner) | kShownRest << corner;
}

/// Writes one of up to three triangles that are drawn in place of a split one.
void show(uint entry, uint index, SplitTriangle t, uint a, uint b, uint c) {
  uint first = entry == 0u ? 3u * t.triangle : 3u * (triangle_count + 2u * index + entry - 1u);
  live[first] = a;
  live[first + 1u] = b;
  live[first + 2u] = c;
}

void main() {
  uint index = globalIndex();
  if (index >= count) return;
  SplitTriangle t = split_triangles[index];
  uint corners[3] = {triangles[3u * t.triangle], triangles[3u * t.triangle + 1u], triangles[3u * t.triangle + 2u]};
  uint shown = shownOf(t), entry = 0u;
  alive[t.triangle] = shown;
  if (shown == kShownWhole) show(entry++, index, t, corners[0], corners[1], corners[2]);
  for (uint i = 0u; i < 3u; ++i) {
    uint j = (i + 1u) % 3u, k = (i + 2u) % 3u;
    uint behind_j = t.vertices[2u * i + 1u], behind_k = t.vertices[2u * k];  // of the edges to j and to k, at their
                                                                             // ends
    if ((shown & kShownCorner << i) != 0u) {
      show(entry++, index, t, corners[i], t.vertices[2u * i], t.vertices[2u * k + 1u]);
    }
    if ((shown & kShownRest << i) != 0u) {
      show(entry++, index, t, behind_j, corners[j], corners[k]);
      show(entry++, index, t, behind_j, corners[k], behind_k);
    }
  }
  for (; entry < 3u; ++entry) show(entry, index, t, 0u, 0u, 0u);
}
