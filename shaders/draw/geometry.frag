// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// geometry.frag - how far along the optical axis what is seen lies, and what it is.   Owner: render/geometry_target.h
#include "layout.h"
#include "tissue_code.glsl"

uniform uint label;  // of a tool or an obstacle; 0: tissue, whose vertices tell
in vec3 position_m;
in vec3 normal;
in vec4 color;
layout(location = 0) out float depth_m;
layout(location = 1) out uint image_label;

void main() {
  depth_m = position_m.z;
  uint first = isWall(color.a) ? kFirstWallLabel : kFirstBodyLabel;
  image_label = label != 0u ? label : first + uint(bodyOf(color.a));
}
