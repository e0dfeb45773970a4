// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// shading.glsl - the light of an operating field, in the optical frame (x right, y down, z forward), linear colours.
// A key lamp above the lens moves with the camera; a hemisphere of fill keeps shadowed sides readable.
const vec3 kToKey = vec3(-0.5000, -0.6124, -0.6124);  // unit
const vec3 kKeyLight = vec3(1.42, 1.36, 1.30);
const vec3 kSkyLight = vec3(0.24, 0.25, 0.28);
const vec3 kGroundLight = vec3(0.06, 0.045, 0.045);
const vec3 kBesideLens_m = vec3(0.0015, -0.0040, 0.0);  // position of the lamp at the lens
const float kCavityFill = 0.5;                          // share of the fill light where no other light reaches
const float kMostNearness = 16.0;                       // largest light at the lens, over that at the distance that it
                                                        // is set for

#ifdef LENS_LIGHT         // some camera has it
uniform int lens_lights;  // 1: the key light is at the lens; 0: it is the lamp
uniform vec2 lens_light;  // x distance at which it is as bright as the lamp [m], y tangent of half its cone
#endif

/// Light at a place.
struct Light {
  vec3 to_key;  // unit
  vec3 key;
  float fill;   // share of the fill light
};

Light lightAt(vec3 position_m) {
  Light light = Light(kToKey, kKeyLight, 1.0);
#ifdef LENS_LIGHT
  for (int i = 0; i < lens_lights; ++i) {
    vec3 offset_m = position_m - kBesideLens_m;
    float away2 = dot(offset_m, offset_m), aside = length(offset_m.xy) / (max(offset_m.z, 1e-6) * lens_light.y);
    float share = exp2(-aside * aside) * min(lens_light.x * lens_light.x / away2, kMostNearness);
    light.to_key = -offset_m * inversesqrt(away2);
    light.key *= share;
    light.fill = kCavityFill * share;  // light reflected by lit tissue around
  }
#endif
  return light;
}

/// Returns the unit normal of the fragment's flat triangle, on the visible side.
vec3 flatNormal(vec3 position_m) {
  vec3 normal = normalize(cross(dFdx(position_m), dFdy(position_m)));
  return dot(normal, position_m) < 0.0 ? normal : -normal;
}

/// Returns the unit normal of a fragment, or of its flat triangle where the mesh has none (torn borders, one-node
/// sheets), on the visible side.
vec3 seenNormal(vec3 mesh_normal, vec3 position_m, bool front) {
  if (dot(mesh_normal, mesh_normal) > 0.01) return normalize(front ? mesh_normal : -mesh_normal);
  return flatNormal(position_m);
}

/// Returns ambient light from a direction: bright from above, dim from below.
vec3 fill(vec3 direction) { return mix(kGroundLight, kSkyLight, 0.5 - 0.5 * direction.y); }

/// Returns diffuse light that extends past the terminator by `wrap` per colour, as in tissue that scatters red light.
vec3 wrappedDiffuse(float n_l, vec3 wrap) {
  vec3 lit = max((n_l + wrap) / (1.0 + wrap), 0.0);
  return lit / (1.0 + 0.5 * wrap);
}

/// Returns the share of light that a smooth film reflects at an angle (Schlick).
float fresnel(float cosine, float straight) {
  float rest = 1.0 - cosine, rest2 = rest * rest;
  return straight + (1.0 - straight) * rest2 * rest2 * rest;
}

/// Returns the GGX distribution over 4, times pi: brightness of a lamp's highlight for a reflectance of 1.
float highlight(float n_h, float roughness) {
  float a = roughness * roughness, a2 = a * a;
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  return 0.25 * a2 / (d * d);
}

/// Compresses values above a knee, so that highlights keep their shape and do not clip.
vec3 shoulder(vec3 light) {
  const float knee = 0.75;
  vec3 over = max(light - knee, 0.0) / (1.0 - knee);
  return min(light, knee) + (1.0 - knee) * over / (1.0 + over);
}
