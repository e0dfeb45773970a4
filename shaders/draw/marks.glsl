// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// marks.glsl - marks on the surface of tissue, drawn by the distance of a fragment's rest position from their lines, so that
// they move with the tissue and part where it is cut.   Owner: surface/marks/mark_textures.h
#include "layout/mark_patterns.h"
layout(binding = kUnitMarkCells) uniform usamplerBuffer mark_cells;       // MarkGrid::cells
layout(binding = kUnitMarkSegments) uniform samplerBuffer mark_segments;  // MarkGrid::segments
layout(binding = kUnitMarkStyles) uniform samplerBuffer mark_styles;      // linear colour, MarkPattern
uniform vec4 mark_space;   // xyz corner of the grid at rest [m], w cells per metre
uniform vec3 mark_counts;  // of cells along each axis

const vec3 kBorderColor = vec3(0.004, 0.004, 0.006);  // linear
const float kOpaque = 0.94;
const float kInkRoughness = 0.55;

/// Returns the distance from the outline of a pattern, negative inside, in half widths.
/// @param along, off  distance along the line and from it, in half widths
float patternAt(float pattern, float along, float off) {
  if (pattern == kDashed) return max(off - 1.0, abs(mod(along + 0.5 * (kDashPeriod - kDash), kDashPeriod) - 0.5 * kDashPeriod) - 0.5 * kDash);
  if (pattern == kDouble) return abs(off - kDoubleOff) - kDoubleHalf;
  if (pattern == kCrossed) {
    float beside = abs(mod(along + 0.5 * kCrossPeriod - kFirstCross, kCrossPeriod) - 0.5 * kCrossPeriod);
    return min(max(0.7071 * abs(beside - off) - kCrossHalf, max(beside, off) - kCrossArm), off - kThinHalf);
  }
  return off - (pattern == kThin ? kThinHalf : 1.0);
}

/// Paints the marks at a place of the surface. @param rest_x, rest_y  its change from pixel to pixel [m]
/// @param bare  a place that has none: a wall, a burn or the line of a cut
void addMarks(vec3 rest, vec3 rest_x, vec3 rest_y, float alpha, bool bare, inout vec3 albedo, inout float roughness) {
  vec3 cell = floor((rest - mark_space.xyz) * mark_space.w);
  if (bare || any(lessThan(cell, vec3(0.0))) || any(greaterThanEqual(cell, mark_counts))) return;
  uint list = texelFetch(mark_cells, int(cell.x + mark_counts.x * (cell.y + mark_counts.y * cell.z))).r;
  int first = int(list >> 8), last = first + int(list & 255u);
  float body = float(bodyOf(alpha)), nearest = 1e9, off = 0.0, along = 0.0, half_width = 1.0, pattern = 0.0;
  vec3 color = vec3(0.0);
  for (int i = first; i < last; ++i) {
    int at = 3 * int(texelFetch(mark_cells, i).r);
    vec4 from = texelFetch(mark_segments, at), to = texelFetch(mark_segments, at + 1), kind = texelFetch(mark_segments, at + 2);
    vec4 style = texelFetch(mark_styles, int(kind.x));
    vec3 offset = to.xyz - from.xyz, off_m = rest - from.xyz;
    float length2 = dot(offset, offset), share = length2 > 0.0 ? clamp(dot(off_m, offset) / length2, 0.0, 1.0) : 0.0;
    float distance_m = length(off_m - share * offset);
    bool drawn = kind.z == body && (uint(kind.y) >> uint(style.w) & 1u) == 1u;
    if (!drawn || distance_m - to.w >= nearest) continue;
    nearest = distance_m - to.w;
    off = distance_m / to.w;
    along = (from.w + share * sqrt(length2)) / to.w;
    half_width = to.w;
    bool plain = length2 == 0.0 || (kind.w == 1.0 && style.w == kCrossed);
    pattern = plain ? 0.0 : style.w;
    color = style.rgb;
  }
  if (nearest == 1e9) return;
  float outline = patternAt(pattern, along, off);
  float per_pixel = max(0.5 * (length(rest_x) + length(rest_y)) / half_width, 1e-6);
  float inside = clamp(0.5 - outline / per_pixel, 0.0, 1.0);
  float border = clamp(0.5 - (outline - kMarkBorder) / per_pixel, 0.0, 1.0);
  albedo = mix(albedo, mix(kBorderColor, color, inside), kOpaque * border);
  roughness = mix(roughness, kInkRoughness, border);
}
