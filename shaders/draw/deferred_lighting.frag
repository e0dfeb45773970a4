// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deferred_lighting.frag - lights a pixel of tissue from the four samples of tissue_g_buffer.frag: once, if all show the same
// surface, or with SEVERAL each by itself.
// GRAIN, DETAIL, MARKS and features of appearance: as in tissue.frag.   Owner: render/deferred_lighting.h
#include "layout.h"
#include "layout/seen.h"
#include "g_buffer_code.glsl"
#include "shading.glsl"
#include "srgb.glsl"
#include "tissue_code.glsl"
#include "tissue_light.glsl"
#ifdef DETAIL
#include "detail.glsl"
#endif
#ifdef GRAIN
#include "grain.glsl"
#endif
#ifdef MARKS
#include "marks.glsl"
#endif

uniform vec4 lens;       // fx, fy, cx, cy of the image [px]
uniform vec2 nearness;   // see pixel_classes.frag
uniform vec2 texel;      // see pixel_classes.frag
uniform vec3 background;
uniform mat4 optical_from_mesh;
layout(binding = kUnitSeenDepths) uniform sampler2D seen_depths;
layout(binding = kUnitSeenPositions) uniform usampler2D seen_positions;
layout(binding = kUnitSeenFinishes) uniform usampler2D seen_finishes;
#ifdef GRAIN
layout(binding = kUnitGrainSlopes) uniform sampler3D grain_slopes;  // see GrainTexture
uniform float steepest_grain;                                       // slope of a texel of 1, per period
#endif
layout(location = 0) out vec4 image;

#ifdef SEVERAL
const bool kWalls = true;
#else
const bool kWalls = false;  // a rasteriser executes all branches for all pixels
#endif
const float kFlattest = 0.05;  // least cosine that is used: surfaces at a flatter angle are treated alike

/// Returns how a point of a plane with a normal moves from pixel to pixel along an axis of the image.
vec3 stepOnPlane(vec3 ray, float z, vec3 n, vec3 across) {
  return z * (across - ray * (dot(n, across) / min(dot(n, ray), -kFlattest)));
}

/// Returns the light of a place. @param outward  outward normal, not of unit length
vec3 lit(vec2 pixel, float depth, vec3 rest, vec3 rest_x, vec3 rest_y, bool rest_known, vec3 outward, bool front, uvec2 finish) {
  float z = 1.0 / (nearness.x + nearness.y * depth);
  vec3 ray = vec3((pixel - lens.zw) / lens.xy, 1.0), position_m = z * ray, to_eye = -normalize(ray);
  float alpha = alphaOf(finish.x);
  bool wall = kWalls && isWall(alpha);
  outward = normalize(outward);
  vec3 n = front ? outward : -outward;
  vec3 position_x = stepOnPlane(ray, z, n, vec3(1.0 / lens.x, 0.0, 0.0)), position_y = stepOnPlane(ray, z, n, vec3(0.0, 1.0 / lens.y, 0.0));
  if (!rest_known) {  // as if the tissue were not deformed
    mat3 turn = transpose(mat3(optical_from_mesh));
    rest_x = turn * position_x;
    rest_y = turn * position_y;
  }
  vec4 appearance = unpackUnorm4x8(finish.y);
  vec3 albedo = linearFromSrgb(appearance.rgb);
  float roughness = kRoughness, shade = 1.0;
  uint beside = finish.x & 0xffffffu;
  bool painted = !wall && beside == kSeenPaint;
#ifdef GRAIN
  vec4 grain = grainAt(rest, 2.0 * appearance.a - 1.0);
  roughness = body_finish[bodyOf(alpha)].x;
#endif
#ifdef DETAIL
  // Half the derivatives of a pixel, as for a sample: coarser texels would mix in neighbouring charts.
  addDetail(wall || painted || beside == kNoSeenChart ? kNoTextureChart : beside, rest, 0.5 * rest_x, 0.5 * rest_y, position_x, position_y, albedo, outward, roughness);
  n = front ? outward : -outward;
#endif
#ifdef GRAIN
  float depth_m = float(beside) * (kDeepestSeen_m / 16777214.0);
  float film = filmAt(grain, alpha);
  addGrain(grain, film, rest, alpha, wall, depth_m, albedo, roughness, shade);
  vec3 slopes = texture(grain_slopes, rest / kFinePeriod_m).xyz * (255.0 / 127.0) - (128.0 / 127.0);
  slopes *= (1.0 - kFilled * film) * reliefOf(alpha) * steepest_grain / kFinePeriod_m;
  n = onRelief(n, dot(slopes, rest_x), dot(slopes, rest_y), position_x, position_y);
#endif
#ifdef MARKS
  addMarks(rest, rest_x, rest_y, alpha, wall || painted, albedo, roughness);
#endif
  return tissueLight(position_m, n, albedo, roughness, shade, front || alpha < 0.5);
}

/// Returns the value that two neighbouring samples share, if any do: then the centre of the pixel is closest to their
/// triangle, and charts end soon outside it. @param of  four samples, around
uint amidst(uvec4 of) {
  bool first = of.w == of.x || of.w == of.z, opposite = of.y == of.x || of.y == of.z;
  return opposite && (!first || of.x == of.z) ? of.y : of.w;
}

void main() {
  ivec2 at = 2 * ivec2(gl_FragCoord.xy);
#ifdef SEVERAL
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 beside = ivec2(i & 1, i >> 1);
    float depth = texelFetch(seen_depths, at + beside, 0).r;
    uvec4 position = texelFetch(seen_positions, at + beside, 0);
    uvec2 finish = texelFetch(seen_finishes, at + beside, 0).xy;
    vec3 light = lit(gl_FragCoord.xy + 0.5 * vec2(beside) - 0.25, depth, uintBitsToFloat(position.xyz), vec3(0.0), vec3(0.0), false,
                     directionOf(position.w), isFront(position.w), finish);
    sum += depth == 1.0 ? background : light;
  }
  image = vec4(0.25 * sum, 1.0);
#else
  uvec4 first = texelFetch(seen_positions, at, 0), right = texelFetch(seen_positions, at + ivec2(1, 0), 0), below = texelFetch(seen_positions, at + ivec2(0, 1), 0);
  vec3 rest = uintBitsToFloat(first.xyz), rest_right = uintBitsToFloat(right.xyz), rest_below = uintBitsToFloat(below.xyz);
  vec3 rest_x = 2.0 * (rest_right - rest), rest_y = 2.0 * (rest_below - rest);
  rest = 0.5 * (rest_right + rest_below);
  float depth = 0.5 * (texelFetch(seen_depths, at + ivec2(1, 0), 0).r + texelFetch(seen_depths, at + ivec2(0, 1), 0).r);
  image = vec4(lit(gl_FragCoord.xy, depth, rest, rest_x, rest_y, true, directionOf(right.w) + directionOf(below.w), isFront(first.w),
                   uvec2(amidst(textureGather(seen_finishes, 2.0 * gl_FragCoord.xy * texel, 0)), texelFetch(seen_finishes, at, 0).y)), 1.0);
#endif
}
