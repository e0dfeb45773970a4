// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue.frag - wet, slightly translucent tissue; a back face is the raw inside, except of a sheet.   Owner:
// render/tissue_painter.h
// Colour's alpha (surface/skins/part_colors.h) says whether it is a sheet, the wall of a wound, or the surface; and the
// body.
// REST: vertices have their rest position. GRAIN: variation from place to place, layers of walls (grain.glsl). DETAIL:
// textures (detail.glsl).
// MARKS: marks on the surface (marks.glsl), PAINT: burns and edges of cuts (skin_paint.glsl), with REST.
// FILM, WALL_GRAIN (grain.glsl), CONTACTS (tissue_light.glsl), LENS_LIGHT (shading.glsl): features of appearance.
#include "layout.h"
#include "shading.glsl"
#include "tissue_code.glsl"
#include "tissue_light.glsl"
#ifdef PAINT
#include "skin_paint.glsl"
#include "srgb.glsl"
#endif
#ifdef DETAIL
#include "detail.glsl"
#endif
#ifdef GRAIN
#include "grain.glsl"
in float patches;
#endif
#if defined(MARKS) && defined(REST)
#include "layout/seen.h"
#include "marks.glsl"
#endif
#ifdef DETAIL
layout(binding = kUnitShownCharts) uniform usamplerBuffer shown_charts;  // of every drawn triangle
uniform int first_chart;  // of this run of them
#endif

in vec3 position_m;
in vec3 normal;
in vec4 color;
#ifdef REST
in vec4 rest;  // xyz place at rest [m], w depth below the surface [m]
#endif
layout(location = 0) out vec4 image;

void main() {
  bool wall = isWall(color.a);  // of a wound: few, large triangles, with smooth normals that may face away
  bool bare = wall;             // no marks
  vec3 albedo = color.rgb, outward = normal;
  float roughness = kRoughness, shade = 1.0;
#ifdef REST
  vec3 rest_x = dFdx(rest.xyz), rest_y = dFdy(rest.xyz), position_x = dFdx(position_m), position_y = dFdy(position_m);
#endif
#ifdef GRAIN
  vec4 grain = grainAt(rest.xyz, patches);
  roughness = body_finish[bodyOf(color.a)].x;
#endif
#ifdef DETAIL
  if (dot(normal, normal) > 0.01) outward = normalize(normal);
  uint chart = texelFetch(shown_charts, first_chart + gl_PrimitiveID).r;
  addDetail(chart, rest.xyz, rest_x, rest_y, position_x, position_y, albedo, outward, roughness);
#endif
#if defined(PAINT) && defined(REST)
  vec3 painted = pow(color.rgb, vec3(1.0 / 2.2));  // near sRGB; its stops replace it where paint covers
  float paint = paintSkin(painted, rest, dFdx(rest), dFdy(rest), wall);
  albedo = mix(albedo, linearFromSrgb(painted), paint);
  bare = wall || paint > 0.5;
#endif
  vec3 n = seenNormal(outward, position_m, gl_FrontFacing);
  vec3 to_eye = -normalize(position_m);
  if (wall && dot(n, to_eye) < kTurnedAway) n = flatNormal(position_m);
#ifdef GRAIN
  float film = filmAt(grain, color.a);
  addGrain(grain, film, rest.xyz, color.a, wall, rest.w, albedo, roughness, shade);
  float relief_m = reliefAt(grain, color.a, wall, film);
  n = onRelief(n, dFdx(relief_m), dFdy(relief_m), position_x, position_y);
#endif
#if defined(MARKS) && defined(REST)
  addMarks(rest.xyz, rest_x, rest_y, color.a, bare, albedo, roughness);
#endif
  image = vec4(tissueLight(position_m, n, albedo, roughness, shade, gl_FrontFacing || color.a < 0.5), 1.0);
}
