// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// grain.glsl - what makes tissue uneven: mottled colour, a relief finer than the skin, and in a wound the layers below the
// skin. All of it is fixed to the rest position, so that it moves and stretches with the tissue, and a cut shows inside what
// was there before.   Owner: render/grain_texture.h
layout(binding = kUnitGrain) uniform sampler3D grain_texture;  // x coarse, y fine, z fibres; 0..1, mean 1/2, periodic
uniform vec4 body_finish[kMaxBodies];               // x roughness, y mottling, z number of layers
uniform vec4 body_layers[kMaxBodies * 4];           // linear colour; w depth to which the layer reaches [m]

const float kFinePeriod_m = 0.017;    // for relief of some 2 mm, and its finest parts of a third of that
const float kRelief_m = 0.00011;      // height of the relief
const float kBorder_m = 0.0004;       // how far a layer's border wanders
const vec3 kPale = vec3(1.13, 1.17, 1.14), kDeep = vec3(0.87, 0.80, 0.82);  // of colours: least and most blood

/// x patches, y relief, z fibres, w a coarser relief: -1..1 about. @param patches  from vertex to vertex
vec4 grainAt(vec3 rest, float patches) {
  vec3 fine = 2.0 * texture(grain_texture, rest / kFinePeriod_m).xyz - 1.0;
  return vec4(patches, fine.y, fine.z, fine.x);
}

/// Height of a relief of 1 [m].
float reliefOf(float alpha) { return alpha < 0.5 ? 0.0 : body_finish[bodyOf(alpha)].y * kRelief_m; }

/// Height of the relief [m].
float reliefAt(vec4 grain, float alpha, bool wall) {
  return reliefOf(alpha) * (grain.y + (wall ? 0.6 * grain.z : 0.0) + 0.5 * grain.w);
}

/// Turns a normal as a relief does whose height [m] changes so from pixel to pixel (Mikkelsen).
vec3 onRelief(vec3 n, float height_x, float height_y, vec3 position_x, vec3 position_y) {
  vec3 across_x = cross(position_y, n), across_y = cross(n, position_x);
  float area = dot(position_x, across_x);
  vec3 slope = sign(area) * (height_x * across_x + height_y * across_y);
  vec3 bent = abs(area) * n - slope;
  return dot(bent, bent) > 0.0 ? normalize(bent) : n;
}

/// Layers from the skin down, with borders that wander; below the last one `flesh` stays.
vec3 layered(vec3 flesh, int body, float depth_m, float wander) {
  float depth = depth_m + kBorder_m * wander * smoothstep(0.0, kBorder_m, depth_m);
  vec3 out_color = flesh;
  for (int i = int(body_finish[body].z) - 1; i >= 0; --i) {
    vec4 layer = body_layers[4 * body + i];
    out_color = mix(layer.rgb, out_color, smoothstep(-0.1, 0.1, (depth - layer.w) / max(layer.w, 1e-6)));
  }
  return out_color;
}

/// @param shade  gets how much light reaches it: less deep inside a wound
void addGrain(vec4 grain, float alpha, bool wall, float depth_m, inout vec3 albedo, inout float roughness, inout float shade) {
  int body = bodyOf(alpha);
  float mottling = body_finish[body].y;
  if (alpha < 0.5) return;  // a sheet is cloth, and even
  if (wall) {
    albedo = layered(albedo, body, depth_m, grain.y);
    shade = mix(1.0, 0.55, depth_m / (depth_m + 0.006));
  }
  float blood = clamp(0.5 + mottling * (0.8 * grain.x + 0.35 * grain.y), 0.0, 1.0);
  float fibres = wall ? grain.z : 0.0;
  albedo *= mix(kPale, kDeep, blood) * (1.0 + 0.22 * mottling * fibres);
  roughness = clamp(roughness + 0.08 * mottling * grain.w, 0.0, 1.0);
}
