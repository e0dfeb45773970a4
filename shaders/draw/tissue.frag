// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue.frag - wet, slightly translucent tissue; a back face is the raw inside, except of a sheet.   Owner: render/tissue_painter.h
// Colour's alpha tells them apart (surface/part_colors.h): a sheet, the wall of a wound, or skin; and the body.
// REST: vertices know their place at rest. GRAIN: what varies from place to place, and layers of walls (grain.glsl). DETAIL: textures
// (detail.glsl).
#include "layout.h"
#include "shading.glsl"
#include "tissue_code.glsl"
#ifdef DETAIL
#include "detail.glsl"
#endif
#ifdef GRAIN
#include "grain.glsl"
#endif

uniform int shafts;  // tools that cast a shadow
uniform vec4 shaft_tips[kMaxStyluses];  // xyz m; w radius of a ball at the tip [m]
uniform vec4 shaft_ends[kMaxStyluses];  // xyz m; w radius of the shaft [m]
in vec3 position_m;
in vec3 normal;
in vec4 color;
#ifdef REST
in vec4 rest;  // xyz place at rest [m], w depth below the skin [m]
#endif
layout(location = 0) out vec4 image;

const vec3 kWrap = vec3(0.42, 0.14, 0.10);         // red light travels furthest
const vec3 kGrazingTint = vec3(0.50, 0.28, 0.30);  // deeper where the line of sight passes through more tissue
const vec3 kRawTint = vec3(0.36, 0.13, 0.13);      // of the inside, on top of the tissue's own colour
const float kFilm = 0.035;                         // reflectance of the fluid film, seen straight on
const float kRoughness = 0.25;                     // of tissue of which nothing else is said
const float kSmoothest = 0.08;                     // a lamp is no point
const float kLampSize = 0.10;                      // of the key lamp, seen from the tissue [rad]: softness of shadows
const float kTurnedAway = 0.2;                     // cosine between a wall's smooth normal and the line of sight below which it is not taken
const float kDeepest = 0.25;                       // share of the key light that reaches a full shadow

/// Share of the key light that passes a tool: the gap between the ray to the lamp and the shaft or the ball at its tip.
float passing(vec4 tip, vec4 end) {
  vec3 shaft = end.xyz - tip.xyz, from_tip = position_m - tip.xyz;
  float shaft_key = dot(shaft, kToKey), from_key = dot(from_tip, kToKey);
  float across = max(dot(shaft, shaft) - shaft_key * shaft_key, 1e-9);
  float along = clamp((dot(from_tip, shaft) - from_key * shaft_key) / across, 0.0, 1.0);
  float reach = max(along * shaft_key - from_key, 0.0), ball_reach = max(-from_key, 0.0);
  float gap = length(from_tip + reach * kToKey - along * shaft) - end.w * min(0.25 + 3.0 * along, 1.0);
  float ball_gap = length(from_tip + ball_reach * kToKey) - tip.w;
  float nearest = min(gap / (0.001 + kLampSize * reach), ball_gap / (0.001 + kLampSize * ball_reach));
  return mix(kDeepest, 1.0, smoothstep(-1.0, 1.0, nearest));
}

void main() {
  bool wall = isWall(color.a);  // of a wound: few, large triangles, whose smooth normals may look away
  vec3 albedo = color.rgb, outward = normal;
  float roughness = kRoughness, shade = 1.0;
#ifdef REST
  vec3 rest_x = dFdx(rest.xyz), rest_y = dFdy(rest.xyz), position_x = dFdx(position_m), position_y = dFdy(position_m);
#endif
#ifdef GRAIN
  vec4 grain = grainAt(rest.xyz);
  roughness = body_finish[bodyOf(color.a)].x;
#endif
#ifdef DETAIL
  if (dot(normal, normal) > 0.01) outward = normalize(normal);
  addDetail(rest.xyz, rest_x, rest_y, position_x, position_y, albedo, outward, roughness);
#endif
  vec3 n = seenNormal(outward, position_m, gl_FrontFacing);
  vec3 to_eye = -normalize(position_m);
  if (wall && dot(n, to_eye) < kTurnedAway) n = flatNormal(position_m);
#ifdef GRAIN
  addGrain(grain, color.a, wall, rest.w, position_x, position_y, albedo, n, roughness, shade);
#endif
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0);
  float n_h = max(dot(n, normalize(kToKey + to_eye)), 0.0);
  vec3 key = kKeyLight;
  for (int i = 0; i < shafts; ++i) key *= passing(shaft_tips[i], shaft_ends[i]);

  bool skin = gl_FrontFacing || color.a < 0.5;
  albedo *= mix(kGrazingTint, vec3(1.0), n_v) * (skin ? vec3(1.0) : kRawTint);
  vec3 diffuse = shade * albedo * (key * wrappedDiffuse(dot(n, kToKey), kWrap) + fill(n));
  float wet = 0.6 * highlight(n_h, max(roughness, kSmoothest)) + 0.3 * highlight(n_h, min(roughness + 0.23, 1.0));
  vec3 gloss = kFilm * wet * key + 0.6 * fresnel(n_v, kFilm) * fill(reflect(-to_eye, n));
  image = vec4(shoulder(diffuse + (skin ? shade : 0.4) * gloss), 1.0);
}
