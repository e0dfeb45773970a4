// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// grain.glsl - what makes tissue uneven: mottled colour, a relief finer than the skin, and in a wound the layers below the
// skin. All of it is fixed to the rest position, so that it moves and stretches with the tissue, and a cut shows inside what
// was there before.   Owner: render/grain_texture.h
layout(binding = kUnitGrain) uniform sampler3D grain_texture;  // x coarse, y fine, z fibres; 0..1, mean 1/2, periodic
uniform vec4 body_finish[kMaxBodies];               // x roughness, y mottling, z number of layers, w wetness
uniform vec4 body_layers[kMaxBodies * 4];           // linear colour; w depth to which the layer reaches [m]
#ifdef WALL_GRAIN  // some body has lobules and bundles
uniform vec4 body_walls[kMaxBodies];                // x how much of them shows
#endif

const float kFinePeriod_m = 0.017;    // for relief of some 2 mm, and its finest parts of a third of that
const float kRelief_m = 0.00011;      // height of the relief
const float kBorder_m = 0.0004;       // how far a layer's border wanders
const float kLobulePeriod_m = 0.034;  // for lobules of some 4 mm, and bundles of a third of that
const float kFilled = 0.8;            // share of the relief that is under the film
const float kFilmRoughness = 0.08;    // of the film: lamps are seen in it
const float kFilmDark = 0.12;         // what a film takes of the light that comes back
const vec3 kSeptum = vec3(0.60, 0.33, 0.25), kSheath = vec3(0.46, 0.20, 0.17);  // linear: what parts lobules, and bundles
const vec3 kPale = vec3(1.13, 1.17, 1.14), kDeep = vec3(0.87, 0.80, 0.82);  // of colours: least and most blood

/// x patches, y relief, z fibres, w a coarser relief: -1..1 about. @param patches  from vertex to vertex
vec4 grainAt(vec3 rest, float patches) {
  vec3 fine = 2.0 * texture(grain_texture, rest / kFinePeriod_m).xyz - 1.0;
  return vec4(patches, fine.y, fine.z, fine.x);
}

/// Is there a film of fluid: 0..1, with soft borders. FILM: some body is wet.
float filmAt(vec4 grain, float alpha) {
#ifdef FILM
  float wetness = body_finish[bodyOf(alpha)].w, over = 0.7 * grain.x + 0.5 * grain.w + 1.2 * wetness - 0.6;
  return wetness > 0.0 && alpha >= 0.5 ? smoothstep(-0.15, 0.15, over) : 0.0;
#else
  return 0.0;
#endif
}

/// Height of a relief of 1 [m].
float reliefOf(float alpha) { return alpha < 0.5 ? 0.0 : body_finish[bodyOf(alpha)].y * kRelief_m; }

/// Height of the relief [m].
float reliefAt(vec4 grain, float alpha, bool wall, float film) {
  return (1.0 - kFilled * film) * reliefOf(alpha) * (grain.y + (wall ? 0.6 * grain.z : 0.0) + 0.5 * grain.w);
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

#ifdef WALL_GRAIN
/// Lobules of fat within the layers, with septa between them, and bundles of muscle below, with sheaths.
vec3 bundled(vec3 color, int body, vec3 rest, vec4 grain, float depth_m) {
  vec3 coarse = 2.0 * textureLod(grain_texture, rest / kLobulePeriod_m, 0.0).xyz - 1.0;  // in a branch: no slopes
  int layers = int(body_finish[body].z);
  float lowest_m = layers > 0 ? body_layers[4 * body + layers - 1].w : 0.0;
  float flesh = smoothstep(-kBorder_m, kBorder_m, depth_m - lowest_m + kBorder_m * grain.y), amount = body_walls[body].x;
  float septum = 1.0 - smoothstep(0.0, 0.22, abs(coarse.x)), sheath = 1.0 - smoothstep(0.0, 0.35, abs(coarse.z + 0.4 * grain.z));
  vec3 fat = mix(color * (1.0 + 0.25 * amount * coarse.y), kSeptum, min(0.5 * amount * septum, 1.0));
  vec3 muscle = mix(color * (1.0 + 0.35 * amount * (coarse.z - 0.3)), kSheath, min(0.3 * amount * sheath, 1.0));
  return max(mix(fat, muscle, flesh), 0.0);
}
#endif

/// @param shade  gets how much light reaches it: less deep inside a wound
void addGrain(vec4 grain, float film, vec3 rest, float alpha, bool wall, float depth_m, inout vec3 albedo, inout float roughness, inout float shade) {
  int body = bodyOf(alpha);
  float mottling = body_finish[body].y;
  if (alpha < 0.5) return;  // a sheet is cloth, and even
  if (wall) {
    albedo = layered(albedo, body, depth_m, grain.y);
#ifdef WALL_GRAIN
    albedo = bundled(albedo, body, rest, grain, depth_m);
#endif
    shade = mix(1.0, 0.55, depth_m / (depth_m + 0.006));
  }
  float blood = clamp(0.5 + mottling * (0.8 * grain.x + 0.35 * grain.y), 0.0, 1.0);
  float fibres = wall ? grain.z : 0.0;
  albedo *= mix(kPale, kDeep, blood) * (1.0 + 0.22 * mottling * fibres) * (1.0 - kFilmDark * film);
  roughness = mix(clamp(roughness + 0.08 * mottling * grain.w, 0.0, 1.0), kFilmRoughness, film);
}
