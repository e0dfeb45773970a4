// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_point.comp - point-centric forces (GW 4.1): every node gathers over its links.   Owner: bench/gw/gw_kernels.h
// in  displacement [nodes], links     out  forces [nodes] N
// Feature ONE_NEIGHBOUR: GW's own method for a mesh of varying valence, with a pass per neighbour over the nodes that
// have that many. Nodes are sorted by falling valence, and passes continue the sums.
#include "gw_mesh.glsl"

layout(std430, binding = 0) buffer Forces { vec4 forces[]; };
#ifdef ONE_NEIGHBOUR
layout(std430, binding = 1) readonly buffer Order { uint by_valence[]; };
uniform uint neighbour;  // index of this pass
#endif

void main() {
  uint i = globalIndex();
  if (i >= count) return;
#ifdef ONE_NEIGHBOUR
  uint node = by_valence[i];
  uint first = linkStart(node) + neighbour, end = first + 1u;
  vec3 force = neighbour == 0u ? vec3(0.0) : forces[node].xyz;
#else
  uint node = i;
  uint first = linkStart(node), end = linkStart(node + 1u);
  vec3 force = vec3(0.0);
#endif
  vec3 u = texelFetch(displacement, int(node)).xyz;
  for (uint l = first; l < end; ++l) {
    Link link = linkAt(l);
    force += linkForce(link, texelFetch(displacement, int(link.far)).xyz - u);
  }
  forces[node] = vec4(force, 0.0);
}
