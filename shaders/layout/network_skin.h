// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What kernels know of the surface meshes of networks.
#ifndef VISCERA_LAYOUT_NETWORK_SKIN_H
#define VISCERA_LAYOUT_NETWORK_SKIN_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A vertex of a network's surface mesh and the range of its ring, the triangles around it.
struct RingVertex {
  uint vertex, slot, ring_begin, ring_end;
  vec4 rest_normal;
};
// A triangle as one of its corners sees it: the nodes of the other two, counter-clockwise.
struct RingTriangle {
  uint slot1, slot2, triangle, pad;
};
// An edge of a network's surface mesh that is a spring. Where a blade crosses the spring two vertices appear: `vertex` follows the end `a`,
// the next one follows `b`.
struct SplitEdge {
  uint a, b;  // indices into RingVertex[]
  uint spring;
  uint vertex;
};
// A triangle with at least one such edge.
struct SplitTriangle {
  uint triangle;
  uint springs[3];   // of the edges 01, 12, 20, or kNoSpring (links.h)
  uint vertices[6];  // of these edges: the vertex next to the edge's first corner, then the one next to its second
  uint slots[3];     // nodes of its corners
  uint pad[3];
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
