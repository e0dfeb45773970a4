// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// mesh.vert - places a vertex in a camera's optical frame.   Owners: render/tissue_painter.h, render/tool_painter.h
// in  position m, normal (null where undefined), sRGB colour     out  the same in the optical frame, linear colour (with SRGB as it is)
#include "srgb.glsl"
#ifdef GRAIN
#include "layout.h"
#endif
layout(location = 0) in vec3 mesh_position_m;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 mesh_color;
#ifdef REST
layout(location = 3) in vec4 mesh_rest;  // xyz m at rest, w depth below the surface [m]
out vec4 rest;
#endif
#ifdef GRAIN
layout(binding = kUnitGrain) uniform sampler3D grain_texture;  // see grain.glsl
out float patches;
const float kPatchPeriod_m = 0.048;  // of the texture, for patches of some 6 mm: larger than triangles
#endif
uniform mat4 optical_from_mesh;
uniform mat4 clip_from_optical;
invariant gl_Position;  // a depth-only pass must give the same
out vec3 position_m;
out vec3 normal;
out vec4 color;

void main() {
  position_m = (optical_from_mesh * vec4(mesh_position_m, 1.0)).xyz;
  normal = mat3(optical_from_mesh) * mesh_normal;
#ifdef REST
  rest = mesh_rest;
#endif
#ifdef GRAIN
  patches = 2.0 * textureLod(grain_texture, mesh_rest.xyz / kPatchPeriod_m, 0.0).x - 1.0;
#endif
#ifdef SRGB
  color = mesh_color;
#else
  color = vec4(linearFromSrgb(mesh_color.rgb), mesh_color.a);
#endif
  gl_Position = clip_from_optical * vec4(position_m, 1.0);
}
