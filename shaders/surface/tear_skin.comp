// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tear_skin.comp - takes out the triangles whose springs were cut (VR05 2.7.3; the rule is in model/body/skin.h).
// Owner: surface/surface.h
// in  triangles[3 * count], skin[vertices], ties[], nodes[slots]     in, out  alive[count], live[3 * count]
// Feature: MIXED (some triangles belong to networks: split_triangles.comp shows them).
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // before globalIndex(), which asks for it
#endif
#include "lattice.glsl"

#ifndef __cplusplus
uniform uint count;  // of triangles
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindSkinBindings) readonly buffer SkinBuffer { SkinBinding skin[]; };
layout(std430, binding = kBindSkinTriangles) readonly buffer TrianglesBuffer { uint triangles[]; };
layout(std430, binding = kBindSkinTies) readonly buffer TiesBuffer { Tie ties[]; };
layout(std430, binding = kBindSkinTieStarts) readonly buffer TieStartsBuffer { uint tie_starts[]; };
layout(std430, binding = kBindSkinAlive) buffer AliveBuffer { uint alive[]; };
layout(std430, binding = kBindSkinLive) writeonly buffer LiveBuffer { uint live[]; };
#endif

uint isAlive(uint slot, uint spring) {
  return springCount(nodes[slot], spring) != 0u ? 1u : 0u;
}

/// Three nodes hang together while two of their three springs are left.
bool vertexHolds(uint vertex) {
  uint springs = skin[vertex].springs;
  return isAlive(skin[vertex].slot0, springs & 31u) + isAlive(skin[vertex].slot1, (springs >> 5) & 31u) +
             isAlive(skin[vertex].slot2, (springs >> 10) & 31u) >= 2u;
}

/// Every group of ties must have a spring left.
bool tiesHold(uint triangle) {
  uint left = 0u;
  for (uint i = tie_starts[triangle]; i < tie_starts[triangle + 1u]; ++i) {
    left += isAlive(ties[i].slot, ties[i].spring & 31u);
    if ((ties[i].spring & kTieEndBit) == 0u) continue;
    if (left == 0u) return false;
    left = 0u;
  }
  return true;
}

void main() {
  uint triangle = globalIndex();
  if (triangle >= count || alive[triangle] == 0u) return;
  uint first = 3u * triangle;
#ifdef MIXED
  if ((skin[triangles[first]].springs & kOneToOneBit) != 0u) return;
#endif
  bool whole = vertexHolds(triangles[first]) && vertexHolds(triangles[first + 1u]) &&
               vertexHolds(triangles[first + 2u]) && tiesHold(triangle);
  if (whole) return;
  alive[triangle] = 0u;
  for (uint i = first; i < first + 3u; ++i) live[i] = 0u;
}
