// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_edge.comp - edge-centric forces (GW 4.2), first pass: each spring once.   Owner: bench/gw/gw_kernels.h
// in  displacement [nodes], springs, links
// out  PER_LINK, as in the solver: link_forces [links] N, both signs, consecutive for each node; otherwise, as in
// GW's force texture: spring_forces [springs] N on end a
#include "gw_mesh.glsl"

layout(binding = kUnitSprings) uniform usamplerBuffer springs;  // SpringEnds
layout(std430, binding = 0) writeonly buffer SpringForces { vec4 spring_forces[]; };

void main() {
  uint i = globalIndex();
  if (i >= count) return;
  uvec4 ends = texelFetch(springs, int(i));  // a, b, link_a, link_b
  vec3 w = texelFetch(displacement, int(ends.y)).xyz - texelFetch(displacement, int(ends.x)).xyz;
  vec3 force = linkForce(linkAt(ends.z), w);
#ifdef PER_LINK
  spring_forces[ends.z] = vec4(force, 0.0);
  spring_forces[ends.w] = vec4(-force, 0.0);
#else
  spring_forces[i] = vec4(force, 0.0);
#endif
}
