// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// skin_paint.glsl - burns and the edges of cuts on a surface, from what its vertices have in rest.w
// (surface/skins/skin_paint.h): minus the share of a burn, or 1 on the lip of a cut. A fragment between vertices is
// pale, browned or charred by its own share, and a lip is a line of one width, whatever the size of triangles.
const float kWave_m = 0.0024;         // of irregular borders
const float kBurnWander = 0.22;       // share of a burn by which its borders wander
const float kLine_m = 0.00028;        // half the width of a closed cut
const vec3 kOoze = vec3(0.30, 0.035, 0.045);  // sRGB: blood that has dried a little
const vec3 kBurnStops[3] = vec3[](vec3(0.804, 0.698, 0.588), vec3(0.408, 0.259, 0.149), vec3(0.102, 0.082, 0.075));  // sRGB,
                                                                                             // as in part_colors.cpp

/// Returns irregular values, -1..1.
float ripple(vec3 rest_m) {
  vec3 at = rest_m * (6.2832 / kWave_m);
  return 0.5 * sin(at.x + 1.7 * sin(0.6 * at.y + 0.3 * at.z)) + 0.5 * sin(1.3 * at.y + at.z + 1.3 * sin(0.7 * at.x));
}

/// Returns a colour under a burn. @param share  0 fresh, 1 coagulated, 2 charred
vec3 burnt(vec3 own, float share, vec3 rest_m) {
  float burn = clamp(share * (1.0 + kBurnWander * ripple(rest_m)), 0.0, 2.0);
  vec3 charred = mix(kBurnStops[1], kBurnStops[2], smoothstep(1.5, 2.0, burn));
  vec3 color = mix(kBurnStops[0], charred, smoothstep(1.0, 1.6, burn));
  return mix(own, color, smoothstep(0.0, 1.0, burn));
}

/// Returns how much of a fragment the line of a cut covers. @param lip  1 on the lip, 0 a triangle away   @param steps
/// how lip changes from pixel to pixel   @param pixel_m  size of a pixel on the surface
float coverAt(float lip, vec2 steps, float pixel_m, vec3 rest_m) {
  float slope = length(steps);
  if (slope < 1e-6) return 0.0;  // all corners are on lips
  float away_m = (1.0 - lip) / slope * pixel_m, half_m = kLine_m * (1.0 + 0.35 * ripple(rest_m));
  return 1.0 - smoothstep(half_m - 0.5 * pixel_m, half_m + 0.5 * pixel_m, away_m);
}

/// Paints a fragment of a surface; walls have none of it. @param own  sRGB   @param rest_x, rest_y  from pixel to pixel
/// @returns the share of it that paint covers
float paintSkin(inout vec3 own, vec4 rest, vec4 rest_x, vec4 rest_y, bool wall) {
  if (wall || rest.w == 0.0) return 0.0;
  vec3 rest_m = vec3(rest.x, rest.y, rest.z);
  if (rest.w < 0.0) {
    own = burnt(own, -rest.w, rest_m);
    return min(-rest.w, 1.0);
  }
  vec3 step_x = vec3(rest_x.x, rest_x.y, rest_x.z), step_y = vec3(rest_y.x, rest_y.y, rest_y.z);
  float covered = coverAt(rest.w, vec2(rest_x.w, rest_y.w), sqrt(length(cross(step_x, step_y))), rest_m);
  own = mix(own, kOoze, covered);
  return covered;
}
