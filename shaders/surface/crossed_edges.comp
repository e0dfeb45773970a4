// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// crossed_edges.comp - lists the edges of networks' meshes that a blade has crossed, for split_edges.comp, in any
// order.
// Owner: surface/network_surface.h
// in  split_edges[count], spring_cut[springs]     in, out  crossed_edges[4 + count], (0, 1, 1, 0) initially
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#include "solver/tissue/lattice.glsl"

uniform uint count;
layout(std430, binding = kBindSplitEdges) readonly buffer SplitEdgesBuffer { SplitEdge split_edges[]; };
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
layout(std430, binding = kBindCrossedEdges) buffer CrossedEdgesBuffer { uint crossed_edges[]; };

void main() {
  uint index = globalIndex();
  if (index >= count || spring_cut[split_edges[index].spring] == 0.0) return;
  uint at = atomicAdd(crossed_edges[3], 1u);
  crossed_edges[4u + at] = index;
  atomicMax(crossed_edges[0], at / uint(GROUP_SIZE) + 1u);
}
