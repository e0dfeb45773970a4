// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// pixel_classes.frag - sorts pixels by their four samples, as depths: one surface, several things, or nothing.
// Owner: render/deferred_lighting.h
#include "layout.h"
#include "layout/seen.h"
#include "tissue_code.glsl"

uniform vec2 nearness;   // 1 / depth [1/m] at the near plane, and the difference to it at the far one
uniform float steepest;  // largest change of 1 / depth within a pixel, over 1 / depth, on one surface
uniform vec2 texel;      // of the samples, in texture coordinates
layout(binding = kUnitSeenDepths) uniform sampler2D seen_depths;
layout(binding = kUnitSeenFinishes) uniform usampler2D seen_finishes;

const float kSeveral = 0.25, kNothing = 0.5, kOne = 1.0;  // see DeferredLighting::light()

void main() {
  vec2 at = 2.0 * gl_FragCoord.xy * texel;  // the corner that four samples share
  vec4 depths = textureGather(seen_depths, at);
  uvec4 codes = textureGather(seen_finishes, at, 0) >> 24;
  vec4 near = nearness.x + nearness.y * depths;
  float nearest = max(max(near.x, near.y), max(near.z, near.w)), farthest = min(min(near.x, near.y), min(near.z, near.w));
  float first = min(min(depths.x, depths.y), min(depths.z, depths.w)), last = max(max(depths.x, depths.y), max(depths.z, depths.w));
  bool wall = isWall(float(codes.x) / 255.0);
  bool several = wall || last == 1.0 || nearest - farthest > steepest * nearest || any(notEqual(codes, codes.wxyz));
  gl_FragDepth = first == 1.0 ? kNothing : several ? kSeveral : kOne;
}
