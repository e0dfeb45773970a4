// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_scatter.vert - a spring as a point at the pixel of one of its ends, in the colour of its force: blending sums the
// forces (GW 4.2).   Owner: bench/gw/gw_blend.h
// in  springs, spring_forces [springs] N     out  colour
#include "layout.h"
#include "bench/gw/gw_units.h"

layout(binding = kUnitSprings) uniform usamplerBuffer springs;  // SpringEnds
layout(binding = kUnitLinkForces) uniform samplerBuffer spring_forces;
uniform uint end;      // 0: a, 1: b
uniform uvec2 size;    // size of the target [px]
uniform float factor;  // factor from force to colour [1/N], with the sign
out vec3 color;

void main() {
  uvec4 ends = texelFetch(springs, gl_VertexID);
  uint node = end == 0u ? ends.x : ends.y;
  vec2 pixel = vec2(node % size.x, node / size.x) + 0.5;
  color = factor * texelFetch(spring_forces, gl_VertexID).xyz;
  gl_Position = vec4(2.0 * pixel / vec2(size) - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
}
