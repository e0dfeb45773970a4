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

// Without branches, sines and smooth steps, as a software rasteriser executes all of it for every sample.

float wave(float x) { return 4.0 * abs(fract(x) - 0.5) - 1.0; }

/// Returns irregular values, -1..1.
float ripple(vec3 rest_m) {
  vec3 at = rest_m * (1.0 / kWave_m);
  return 0.5 * wave(at.x + 0.27 * wave(0.6 * at.y + 0.3 * at.z)) + 0.5 * wave(1.3 * at.y + at.z + 0.2 * wave(0.7 * at.x));
}

float ramp(float from, float to, float x) { return clamp((x - from) * (1.0 / (to - from)), 0.0, 1.0); }

/// Returns a colour under a burn. @param share  0 fresh, 1 coagulated, 2 charred
vec3 burnt(vec3 own, float share, float wander) {
  float burn = share * (1.0 + kBurnWander * wander);
  vec3 charred = mix(kBurnStops[1], kBurnStops[2], ramp(1.5, 2.0, burn));
  return mix(own, mix(kBurnStops[0], charred, ramp(1.0, 1.6, burn)), ramp(0.0, 1.0, burn));
}

/// Returns how much of a fragment the line of a cut covers. @param lip  1 on the lip, 0 a triangle away   @param steps
/// how lip changes from pixel to pixel   @param pixel_m  size of a pixel on the surface
float coverAt(float lip, vec2 steps, float pixel_m, float wander) {
  float slope = length(steps);
  if (slope < 1e-6) return 0.0;  // all corners are on lips
  float away_m = (1.0 - lip) / slope * pixel_m, half_m = kLine_m * (1.0 + 0.35 * wander);
  float on_lip = ramp(0.6, 0.8, lip);  // of a sliver along the lip, not all
  return on_lip * (1.0 - ramp(half_m - 0.5 * pixel_m, half_m + 0.5 * pixel_m, away_m));
}

/// Paints a fragment of a surface; walls have none of it. @param own  sRGB   @param rest_x, rest_y  from pixel to pixel
/// @returns the share of it that paint covers
float paintSkin(inout vec3 own, vec4 rest, vec4 rest_x, vec4 rest_y, bool wall) {
  if (wall || rest.w == 0.0) return 0.0;
  float wander = ripple(vec3(rest.x, rest.y, rest.z));
  if (rest.w < 0.0) {
    own = burnt(own, -rest.w, wander);
    return min(-rest.w, 1.0);
  }
  vec3 step_x = vec3(rest_x.x, rest_x.y, rest_x.z), step_y = vec3(rest_y.x, rest_y.y, rest_y.z);
  float covered = coverAt(rest.w, vec2(rest_x.w, rest_y.w), sqrt(length(cross(step_x, step_y))), wander);
  own = mix(own, kOoze, covered);
  return covered;
}
