// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_strain.frag - a surface in the colours of a scale, shaded by a lamp at the eye.   Owner:
// render/overlay_painter.h
#include "shading.glsl"

in vec3 position_m;
in vec3 normal;
in vec4 color;
layout(location = 0) out vec4 image;

void main() {
  float facing = abs(dot(seenNormal(normal, position_m, gl_FrontFacing), normalize(position_m)));
  image = vec4(color.rgb * (0.45 + 0.55 * facing), 1.0);
}
