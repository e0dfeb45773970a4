// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_sum.comp - edge-centric forces (GW 4.2), accumulation as a gather over a node's run, in a fixed order.
// Owner: bench/gw/gw_kernels.h
// in  forces of springs, node by node     out  forces [nodes] N
#include "gw_mesh.glsl"

layout(binding = kUnitLinkForces) uniform samplerBuffer link_forces;
layout(std430, binding = 0) writeonly buffer Forces { vec4 forces[]; };

void main() {
  uint node = globalIndex();
  if (node >= count) return;
  vec3 force = vec3(0.0);
  uint end = linkStart(node + 1u);
  for (uint link = linkStart(node); link < end; ++link) force += texelFetch(link_forces, int(link)).xyz;
  forces[node] = vec4(force, 0.0);
}
