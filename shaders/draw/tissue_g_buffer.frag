// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue_g_buffer.frag - stores place and orientation of visible tissue for deferred_lighting.frag: lighting the fragments of
// small triangles is what costs a software rasteriser most.   Owner: render/tissue_painter.h
// GRAIN, DETAIL, PAINT: as in tissue.frag.
#include "layout.h"
#include "layout/seen.h"
#include "g_buffer_code.glsl"
#include "shading.glsl"
#include "tissue_code.glsl"
#ifdef PAINT
#include "skin_paint.glsl"
#endif

#ifdef DETAIL
layout(binding = kUnitShownCharts) uniform usamplerBuffer shown_charts;
uniform int first_chart;
#endif
in vec3 position_m;
in vec3 normal;
in vec4 color;  // sRGB
in vec4 rest;
#ifdef GRAIN
in float patches;
#endif
layout(location = 0) out uvec4 position;
layout(location = 1) out uvec2 finish;

void main() {
  bool wall = isWall(color.a);
  vec3 outward = seenNormal(normal, position_m, true);
  vec3 flat_normal = flatNormal(position_m);
  bool turned_away = wall && dot(gl_FrontFacing ? outward : -outward, normalize(-position_m)) < kTurnedAway;
  if (turned_away || dot(normal, normal) <= 0.01) outward = gl_FrontFacing ? flat_normal : -flat_normal;
  position = uvec4(floatBitsToUint(rest.xyz), directionCode(outward, gl_FrontFacing));
  uint beside = wall ? uint(clamp(rest.w / kDeepestSeen_m, 0.0, 1.0) * 16777214.0) : kNoSeenChart;
#ifdef DETAIL
  uint chart = texelFetch(shown_charts, first_chart + gl_PrimitiveID).r;
  if (!wall && chart != kNoTextureChart) beside = chart;
#endif
  vec3 own = color.rgb;
#ifdef PAINT
  if (paintSkin(own, rest, dFdx(rest), dFdy(rest), wall) > 0.5) beside = kSeenPaint;
#endif
  finish.x = uint(color.a * 255.0 + 0.5) << 24 | beside;
  float of_patches = 0.0;
#ifdef GRAIN
  of_patches = patches;
#endif
  finish.y = packUnorm4x8(vec4(own, 0.5 + 0.5 * of_patches));
}
