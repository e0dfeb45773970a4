// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue_light.glsl - the light that comes from wet, slightly translucent tissue, with the shadows of tools.
uniform int shafts;  // tools that cast a shadow
uniform vec4 shaft_tips[kMaxStyluses];  // xyz m; w radius of a ball at the tip [m]
uniform vec4 shaft_ends[kMaxStyluses];  // xyz m; w radius of the shaft [m]

const vec3 kWrap = vec3(0.42, 0.14, 0.10);         // red light travels furthest
const vec3 kGrazingTint = vec3(0.50, 0.28, 0.30);  // deeper where the line of sight passes through more tissue
const vec3 kRawTint = vec3(0.36, 0.13, 0.13);      // of the inside, on top of the tissue's own colour
const float kFilm = 0.035;                         // reflectance of the fluid film, seen straight on
const float kRoughness = 0.25;                     // of tissue of which nothing else is said
const float kSmoothest = 0.08;                     // a lamp is no point
const float kLampSize = 0.10;                      // of the key lamp, seen from the tissue [rad]: softness of shadows
const float kDeepest = 0.25;                       // share of the key light that reaches a full shadow

/// Share of the key light that passes a tool: the gap between the ray to the lamp and the shaft or the ball at its tip.
float passing(vec3 position_m, vec4 tip, vec4 end) {
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

/// @param n  unit normal of the side that is seen   @param shade  how much light reaches the place   @param skin  it is no raw inside
vec3 tissueLight(vec3 position_m, vec3 n, vec3 albedo, float roughness, float shade, bool skin) {
  vec3 to_eye = -normalize(position_m);
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0);
  float n_h = max(dot(n, normalize(kToKey + to_eye)), 0.0);
  vec3 key = kKeyLight;
  for (int i = 0; i < shafts; ++i) key *= passing(position_m, shaft_tips[i], shaft_ends[i]);

  albedo *= mix(kGrazingTint, vec3(1.0), n_v) * (skin ? vec3(1.0) : kRawTint);
  vec3 diffuse = shade * albedo * (key * wrappedDiffuse(dot(n, kToKey), kWrap) + fill(n));
  float wet = 0.6 * highlight(n_h, max(roughness, kSmoothest)) + 0.3 * highlight(n_h, min(roughness + 0.23, 1.0));
  vec3 gloss = kFilm * wet * key + 0.6 * fresnel(n_v, kFilm) * fill(reflect(-to_eye, n));
  return shoulder(diffuse + (skin ? shade : 0.4) * gloss);
}
