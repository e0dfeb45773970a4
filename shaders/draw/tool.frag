// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tool.frag - satin metal; vertices with alpha < 1 are an outline, densest at its rim.   Owner: render/tool_painter.h
// LENS_LIGHT: as in tissue.frag.
#include "shading.glsl"

in vec3 position_m;
in vec3 normal;
in vec4 color;
layout(location = 0) out vec4 image;

const float kSolid = 0.99;  // least alpha of solid parts: interpolation of 1 may give a little less

/// Returns what metal reflects: the fill light with a dark horizon, which shows its roundness.
vec3 environment(vec3 direction) { return fill(direction) * (1.0 - smoothstep(-0.6, 0.7, direction.y)); }

void main() {
  vec3 n = seenNormal(normal, position_m, gl_FrontFacing);
  vec3 to_eye = -normalize(position_m);
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0);
  Light light = lightAt(position_m);
  float n_h = max(dot(n, normalize(light.to_key + to_eye)), 0.0);

  vec3 diffuse = 0.55 * color.rgb * (light.key * max(dot(n, light.to_key), 0.0) + light.fill * fill(n));
  vec3 gloss = color.rgb * (0.8 * light.key * highlight(n_h, 0.40) + 1.6 * light.fill * environment(reflect(-to_eye, n)));
  float rim = (1.0 - n_v) * (1.0 - n_v);
  image = vec4(shoulder(diffuse + gloss), color.a < kSolid ? color.a * (0.08 + 0.92 * rim) : 1.0);
}
