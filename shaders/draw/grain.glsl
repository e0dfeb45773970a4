// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// grain.glsl - variation of tissue: mottled colour, a relief finer than the surface mesh, and in a wound the layers
// below the surface. All of it is fixed to the rest position, so that it moves and stretches with the tissue, and a cut
// shows what was inside before.   Owner: render/grain_texture.h
layout(binding = kUnitGrain) uniform sampler3D grain_texture;  // x coarse, y fine, z fibres; 0..1, mean 1/2, periodic
uniform vec4 body_finish[kMaxBodies];               // x roughness, y color_variation, z number of layers, w specular_wetness
uniform vec4 body_layers[kMaxBodies * 4];           // linear colour; w depth of the layer's lower border [m]
#ifdef WALL_GRAIN  // some body has lobules and bundles
uniform vec4 body_walls[kMaxBodies];                // x strength
#endif

const float kFinePeriod_m = 0.017;    // for relief of some 2 mm, with detail of a third of that
const float kRelief_m = 0.00011;      // height of the relief
const float kBorder_m = 0.0004;       // amplitude of a layer's border
const float kLobulePeriod_m = 0.034;  // for lobules of some 4 mm, and bundles of a third of that
const float kFilled = 0.8;            // share of the relief that is under the film
const float kFilmRoughness = 0.08;    // of the film: lamps are reflected in it
const float kFilmDark = 0.12;         // share of the returning light that a film absorbs
const vec3 kSeptum = vec3(0.60, 0.33, 0.25), kSheath = vec3(0.46, 0.20, 0.17);  // linear: between lobules, and between
                                                                                // bundles
const float kOoze_m = 0.0006;                        // depth to which the edge of a cut oozes
const vec3 kOozing = vec3(0.085, 0.0035, 0.0045);    // linear
const vec3 kPale = vec3(1.13, 1.17, 1.14), kDeep = vec3(0.87, 0.80, 0.82);  // of colours: least and most blood

/// Returns x patches, y relief, z fibres, w a coarser relief: about -1..1. @param patches  from vertex to vertex
vec4 grainAt(vec3 rest, float patches) {
  vec3 fine = 2.0 * texture(grain_texture, rest / kFinePeriod_m).xyz - 1.0;
  return vec4(patches, fine.y, fine.z, fine.x);
}

/// Returns the presence of a film of fluid, 0..1, with soft borders. FILM: some body is wet.
float filmAt(vec4 grain, float alpha) {
#ifdef FILM
  float specular_wetness = body_finish[bodyOf(alpha)].w, over = 0.7 * grain.x + 0.5 * grain.w + 1.2 * specular_wetness - 0.6;
  return specular_wetness > 0.0 && alpha >= 0.5 ? smoothstep(-0.15, 0.15, over) : 0.0;
#else
  return 0.0;
#endif
}

/// Returns the height of a relief of 1 [m].
float reliefOf(float alpha) { return alpha < 0.5 ? 0.0 : body_finish[bodyOf(alpha)].y * kRelief_m; }

/// Returns the height of the relief [m].
float reliefAt(vec4 grain, float alpha, bool wall, float film) {
  return (1.0 - kFilled * film) * reliefOf(alpha) * (grain.y + (wall ? 0.6 * grain.z : 0.0) + 0.5 * grain.w);
}

/// Returns a normal turned by a relief with these changes of height [m] from pixel to pixel (Mikkelsen).
vec3 onRelief(vec3 n, float height_x, float height_y, vec3 position_x, vec3 position_y) {
  vec3 across_x = cross(position_y, n), across_y = cross(n, position_x);
  float area = dot(position_x, across_x);
  vec3 slope = sign(area) * (height_x * across_x + height_y * across_y);
  vec3 bent = abs(area) * n - slope;
  return dot(bent, bent) > 0.0 ? normalize(bent) : n;
}

/// Returns the colour of the layers from the surface down, with irregular borders; `flesh` below the last one.
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
/// Adds lobules of fat within the layers, with septa between them, and bundles of muscle below, with sheaths.
vec3 bundled(vec3 color, int body, vec3 rest, vec4 grain, float depth_m) {
  vec3 coarse = 2.0 * textureLod(grain_texture, rest / kLobulePeriod_m, 0.0).xyz - 1.0;  // in a branch: no derivatives
  int layers = int(body_finish[body].z);
  float lowest_m = layers > 0 ? body_layers[4 * body + layers - 1].w : 0.0;
  float flesh = smoothstep(-kBorder_m, kBorder_m, depth_m - lowest_m + kBorder_m * grain.y), amount = body_walls[body].x;
  float septum = 1.0 - smoothstep(0.0, 0.22, abs(coarse.x)), sheath = 1.0 - smoothstep(0.0, 0.35, abs(coarse.z + 0.4 * grain.z));
  vec3 fat = mix(color * (1.0 + 0.25 * amount * coarse.y), kSeptum, min(0.5 * amount * septum, 1.0));
  vec3 muscle = mix(color * (1.0 + 0.35 * amount * (coarse.z - 0.3)), kSheath, min(0.3 * amount * sheath, 1.0));
  return max(mix(fat, muscle, flesh), 0.0);
}
#endif

/// Adds the variation to a fragment. @param shade  gets the share of light, which is less deep inside a wound
void addGrain(vec4 grain, float film, vec3 rest, float alpha, bool wall, float depth_m, inout vec3 albedo, inout float roughness, inout float shade) {
  int body = bodyOf(alpha);
  float color_variation = body_finish[body].y;
  if (alpha < 0.5) return;  // a sheet is cloth, without variation
  if (wall) {
    albedo = layered(albedo, body, depth_m, grain.y);
#ifdef WALL_GRAIN
    albedo = bundled(albedo, body, rest, grain, depth_m);
#endif
    albedo = mix(kOozing, albedo, smoothstep(0.3 * kOoze_m, kOoze_m, depth_m * (1.0 + 0.3 * grain.y)));
    shade = mix(1.0, 0.55, depth_m / (depth_m + 0.006));
  }
  float blood = clamp(0.5 + color_variation * (0.8 * grain.x + 0.35 * grain.y), 0.0, 1.0);
  float fibres = wall ? grain.z : 0.0;
  albedo *= mix(kPale, kDeep, blood) * (1.0 + 0.22 * color_variation * fibres) * (1.0 - kFilmDark * film);
  roughness = mix(clamp(roughness + 0.08 * color_variation * grain.w, 0.0, 1.0), kFilmRoughness, film);
}
