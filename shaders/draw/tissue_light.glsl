// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue_light.glsl - light reflected by wet, slightly translucent tissue, with the shadows of tools.
uniform int shafts;  // tools that cast a shadow
uniform vec4 shaft_tips[kMaxStyluses];  // xyz m; w radius of a ball at the tip [m]
uniform vec4 shaft_ends[kMaxStyluses];  // xyz m; w radius of the shaft [m]
#ifdef CONTACTS         // some camera shows contact shadows
uniform int contacts;   // as shafts, or 0: no contact shadows
uniform float contact;  // strength of contact shadows
#endif

const vec3 kWrap = vec3(0.42, 0.14, 0.10);         // red light travels furthest
const vec3 kGrazingTint = vec3(0.50, 0.28, 0.30);  // deeper where the line of sight passes through more tissue
const vec3 kRawTint = vec3(0.36, 0.13, 0.13);      // of the inside, on top of the tissue's own colour
const float kFilm = 0.035;                         // reflectance of the fluid film, seen straight on
const float kRoughness = 0.25;                     // of tissue without a roughness of its own
const float kSmoothest = 0.08;                     // a lamp is not a point
const float kLampSize = 0.10;                      // of the key lamp, seen from the tissue [rad]: softness of shadows
const float kDeepest = 0.25;                       // share of the key light that reaches a full shadow

/// Returns the radius of a shaft, which is pointed, at a share of its length [m].
float shaftRadius(vec4 end, float along) { return end.w * min(0.25 + 3.0 * along, 1.0); }

/// Returns the share of the key light that passes a tool, by the gap between the ray to the lamp and the shaft or the
/// ball at its tip.
float passing(vec3 position_m, vec3 to_key, vec4 tip, vec4 end) {
  vec3 shaft = end.xyz - tip.xyz, from_tip = position_m - tip.xyz;
  float shaft_key = dot(shaft, to_key), from_key = dot(from_tip, to_key);
  float across = max(dot(shaft, shaft) - shaft_key * shaft_key, 1e-9);
  float along = clamp((dot(from_tip, shaft) - from_key * shaft_key) / across, 0.0, 1.0);
  float reach = max(along * shaft_key - from_key, 0.0), ball_reach = max(-from_key, 0.0);
  float gap = length(from_tip + reach * to_key - along * shaft) - shaftRadius(end, along);
  float ball_gap = length(from_tip + ball_reach * to_key) - tip.w;
  float nearest = min(gap / (0.001 + kLampSize * reach), ball_gap / (0.001 + kLampSize * ball_reach));
  return mix(kDeepest, 1.0, smoothstep(-1.0, 1.0, nearest));
}

/// Returns the share of a place's sky that a ball leaves open. @param away_m  from its centre to the place
float openBeside(vec3 away_m, float radius_m, vec3 n) {
  float away2 = max(dot(away_m, away_m), 1e-12);
  float facing = max(-dot(away_m, n), 0.0) * inversesqrt(away2);
  return 1.0 - min(facing * radius_m * radius_m / away2, 1.0);
}

/// Returns the same of a tool: of the ball at its tip, and of the nearest one within its shaft.
float openBesideTool(vec3 position_m, vec3 n, vec4 tip, vec4 end) {
  vec3 shaft = end.xyz - tip.xyz, from_tip = position_m - tip.xyz;
  float along = clamp(dot(from_tip, shaft) / max(dot(shaft, shaft), 1e-12), 0.0, 1.0);
  return openBeside(from_tip, tip.w, n) * openBeside(from_tip - along * shaft, shaftRadius(end, along), n);
}

/// Returns the light of a place. @param n  unit normal of the visible side   @param shade  share of light that reaches
/// the place   @param skin  it is not the raw inside
vec3 tissueLight(vec3 position_m, vec3 n, vec3 albedo, float roughness, float shade, bool skin) {
  vec3 to_eye = -normalize(position_m);
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0);
  Light light = lightAt(position_m);
  float n_h = max(dot(n, normalize(light.to_key + to_eye)), 0.0);
  vec3 key = light.key;
  for (int i = 0; i < shafts; ++i) key *= passing(position_m, light.to_key, shaft_tips[i], shaft_ends[i]);
#ifdef CONTACTS
  for (int i = 0; i < contacts; ++i) shade *= mix(1.0, openBesideTool(position_m, n, shaft_tips[i], shaft_ends[i]), contact);
#endif

  albedo *= mix(kGrazingTint, vec3(1.0), n_v) * (skin ? vec3(1.0) : kRawTint);
  vec3 diffuse = shade * albedo * (key * wrappedDiffuse(dot(n, light.to_key), kWrap) + light.fill * fill(n));
  float wet = 0.6 * highlight(n_h, max(roughness, kSmoothest)) + 0.3 * highlight(n_h, min(roughness + 0.23, 1.0));
  vec3 gloss = kFilm * wet * key + 0.6 * light.fill * fresnel(n_v, kFilm) * fill(reflect(-to_eye, n));
  return shoulder(diffuse + (skin ? shade : 0.4) * gloss);
}
