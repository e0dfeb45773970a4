// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// detail.glsl - adds textures to the colours of vertices: colour, normal map and roughness (docs/surface.md).
// Texture coordinates are affine functions of the rest position, one per triangle of the uncut mesh (TextureChart), so
// that a cut changes none of them. The tangent frame is that of the deformed triangle.   Owner:
// render/detail_textures.h
layout(binding = kUnitCharts) uniform samplerBuffer charts;              // 3 texels each: u, v, (material, 0, 0, 0)
layout(binding = kUnitMaterials) uniform samplerBuffer materials;        // 3 texels each, see DetailTextures
layout(binding = kUnitColors) uniform sampler2DArray skin_colors;
layout(binding = kUnitReliefs) uniform sampler2DArray skin_reliefs;      // xyz normal, w roughness

/// Returns a coordinate for repeating textures: as it is, mirrored, or clamped to texel centres.
float wrapped(float x, float mode, float half_texel) {
  if (mode == 0.0) return x;
  float within = mode == 1.0 ? abs(mod(x - 1.0, 2.0) - 1.0) : x;
  return clamp(within, half_texel, 1.0 - half_texel);
}

vec4 picture(sampler2DArray of, float layer, vec2 uv, vec2 modes, vec2 per_x, vec2 per_y) {
  vec2 half_texel = 0.5 / vec2(textureSize(of, 0).xy);
  vec2 at = vec2(wrapped(uv.x, modes.x, half_texel.x), wrapped(uv.y, modes.y, half_texel.y));
  return textureGrad(of, vec3(at, layer), per_x, per_y);
}

/// Returns the normal of a normal map about n, the outward normal. Tangents are computed from how position and
/// coordinates change from pixel to pixel: exact for the deformed triangle, without stored tangents.
vec3 reliefNormal(vec3 n, vec3 relief, vec3 position_x, vec3 position_y, vec2 uv_x, vec2 uv_y) {
  float area = uv_x.x * uv_y.y - uv_x.y * uv_y.x;
  float side = area < 0.0 ? -1.0 : 1.0;
  vec3 along_u = side * (position_x * uv_y.y - position_y * uv_x.y), along_v = side * (position_y * uv_x.x - position_x * uv_y.x);
  vec3 t = along_u - n * dot(n, along_u);
  float length2 = dot(t, t);
  if (area == 0.0 || !(length2 > 0.0)) return n;
  t *= inversesqrt(length2);
  vec3 b = cross(n, t) * (dot(cross(along_u, along_v), n) < 0.0 ? -1.0 : 1.0);
  return normalize(relief.x * t + relief.y * b + relief.z * n);
}

/// Adds the textures of the fragment's triangle to the material of its vertices. n is the outward normal.
void addDetail(uint chart, vec3 rest, vec3 rest_x, vec3 rest_y, vec3 position_x, vec3 position_y, inout vec3 albedo, inout vec3 n,
               inout float roughness) {
  if (chart == kNoTextureChart) return;
  vec4 u = texelFetch(charts, int(3u * chart)), v = texelFetch(charts, int(3u * chart + 1u));
  int material = 3 * int(texelFetch(charts, int(3u * chart + 2u)).x);
  vec4 finish = texelFetch(materials, material), layers = texelFetch(materials, material + 1), modes = texelFetch(materials, material + 2);
  vec2 uv = vec2(dot(u.xyz, rest) + u.w, dot(v.xyz, rest) + v.w);
  vec2 uv_x = vec2(dot(u.xyz, rest_x), dot(v.xyz, rest_x)), uv_y = vec2(dot(u.xyz, rest_y), dot(v.xyz, rest_y));
  if (layers.w == 1.0) albedo = finish.rgb;
  if (finish.w >= 0.0) roughness = finish.w;
  if (layers.x >= 0.0) {
    vec4 painted = picture(skin_colors, layers.x, uv, modes.xy, uv_x, uv_y);
    albedo = layers.w == 2.0 ? mix(albedo, painted.rgb, painted.a) : albedo * painted.rgb;
  }
  if (layers.y < 0.0) return;
  vec4 relief = picture(skin_reliefs, layers.y, uv, modes.zw, uv_x, uv_y);
  vec3 bent = relief.xyz * (255.0 / 127.5) - (128.0 / 127.5);  // 128 is 0: flat texels are exactly flat
  float straight = clamp(length(bent) / 0.985, 0.1, 1.0);  // 8-bit texels are up to this much too short
  n = reliefNormal(n, vec3(layers.z * bent.xy, bent.z), position_x, position_y, uv_x, uv_y);
  // Normals that differ within a pixel become roughness (Toksvig).
  roughness = sqrt(sqrt(min(pow(max(roughness, 0.0) * relief.w, 4.0) + 0.5 * (1.0 - straight), 1.0)));
}
