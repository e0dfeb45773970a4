// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// lens.frag - the image of a lens with distortion, from that of a pinhole.   Owner: render/lens.h
// GEOMETRY: depths and labels. A pixel has the label of the nearest pinhole pixel, and its depth or, where the
// neighbours are of one surface, the depth of the plane there.
#include "layout.h"
#include "layout/seen.h"

layout(binding = kUnitSights) uniform sampler2D sights;
#ifdef GEOMETRY
layout(binding = kUnitPinholeDepths) uniform sampler2D pinhole_depths;
layout(binding = kUnitPinholeLabels) uniform usampler2D pinhole_labels;
uniform float steepest;  // see pixel_classes.frag
layout(location = 0) out float depth_m;
layout(location = 1) out uint image_label;
#else
layout(binding = kUnitPinhole) uniform sampler2D pinhole;
layout(location = 0) out vec4 image;
#endif

void main() {
  vec2 sight = texelFetch(sights, ivec2(gl_FragCoord.xy), 0).xy;
#ifdef GEOMETRY
  ivec2 nearest = ivec2(sight), first = ivec2(sight - 0.5);
  depth_m = texelFetch(pinhole_depths, nearest, 0).r;
  image_label = texelFetch(pinhole_labels, nearest, 0).r;
  if (image_label == 0u) return;
  float least = 1.0 / depth_m, most = least, mean = 0.0;  // of 1 / depth [1/m], which is linear on a plane
  bool one = true;
  for (int i = 0; i < 4; ++i) {
    ivec2 at = first + ivec2(i & 1, i >> 1);
    float near = 1.0 / max(texelFetch(pinhole_depths, at, 0).r, 1e-9);
    vec2 share = 1.0 - abs(sight - (vec2(at) + 0.5));
    one = one && texelFetch(pinhole_labels, at, 0).r == image_label;
    least = min(least, near);
    most = max(most, near);
    mean += share.x * share.y * near;
  }
  if (one && most - least < steepest * most) depth_m = 1.0 / mean;
#else
  image = texture(pinhole, sight / vec2(textureSize(pinhole, 0)));
#endif
}
