// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// geometry.frag - depth along the optical axis, and label.   Owners: render/renderer.h, render/obstacle_painter.h
// ROUND: of a sphere or a capsule, drawn with triangles a little larger than it; pixels outside it are discarded.
#include "layout.h"
#include "tissue_code.glsl"

uniform uint label;  // of a tool or an obstacle; 0: tissue, with labels in its vertices
in vec3 position_m;
in vec3 normal;
in vec4 color;
layout(location = 0) out float depth_m;
layout(location = 1) out uint image_label;

#ifdef ROUND
uniform mat4 clip_from_optical;
uniform vec4 first_end;  // xyz m, of the centre line, optical frame; w radius [m]
uniform vec4 last_end;   // xyz m
const float kBehindSlope = 2.0, kBehind = 16.0 / 16777216.0;  // as obstacles are drawn: tissue in contact with one is
                                                              // shown
const float kMissed = 1e30;

// Returns where the ray t * way, from the camera, first meets a sphere: t, or kMissed.
float sphereAt(vec3 direction, vec3 centre_m, float radius_m) {
  float middle = dot(direction, centre_m) / dot(direction, direction);
  vec3 off_m = centre_m - middle * direction;  // a difference of squares would cancel at the rim
  float rest = radius_m * radius_m - dot(off_m, off_m);
  float t = middle - sqrt(max(rest, 0.0) / dot(direction, direction));
  return rest >= 0.0 && t > 0.0 ? t : kMissed;
}

// Returns the same for the wall of the cylinder between the ends.
float wallAt(vec3 direction, vec3 from_m, vec3 along_m, float radius_m) {
  float length2 = dot(along_m, along_m);
  if (length2 == 0.0) return kMissed;
  vec3 across = direction - along_m * (dot(along_m, direction) / length2), off_m = from_m - along_m * (dot(along_m, from_m) / length2);
  float t = sphereAt(across, off_m, radius_m);
  float share = dot(t * direction - from_m, along_m) / length2;
  return t < kMissed && share >= 0.0 && share <= 1.0 ? t : kMissed;
}
#endif

void main() {
  depth_m = position_m.z;
#ifdef ROUND
  vec3 direction = position_m / position_m.z;
  float t = min(sphereAt(direction, first_end.xyz, first_end.w), sphereAt(direction, last_end.xyz, first_end.w));
  t = min(t, wallAt(direction, first_end.xyz, last_end.xyz - first_end.xyz, first_end.w));
  depth_m = t;
  vec4 clip = clip_from_optical * vec4(t * direction, 1.0);
  float depth = 0.5 + 0.5 * clip.z / clip.w;
  float slope = fwidth(depth);
  if (t == kMissed) discard;
  gl_FragDepth = min(depth + kBehindSlope * min(slope, 1e-4) + kBehind, 1.0);
#endif
  uint first = isWall(color.a) ? kFirstWallLabel : kFirstBodyLabel;
  image_label = label != 0u ? label : first + uint(bodyOf(color.a));
}
