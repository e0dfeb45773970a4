// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// legend.frag - the scale of an overlay: a bar of its colours, its end in digits above, zero below.   Owner: render/overlay_painter.h
#include "srgb.glsl"
#include "strain_scale.glsl"

in vec2 at;
uniform vec4 digits;  // of the number at the end of the scale: 0..9, 10: a point, 11: empty
layout(location = 0) out vec4 image;

const float kTextHeight = 0.09;  // of the rectangle
const uint kSegments[10] = uint[10](63u, 6u, 91u, 79u, 102u, 109u, 125u, 7u, 127u, 111u);  // bits: top, then clockwise, the middle one last

/// Returns whether a place is in a line of 0.16 width around the segment a-b.
bool on(vec2 p, vec2 a, vec2 b) {
  vec2 ab = b - a;
  return length(p - a - clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0) * ab) < 0.08;
}

/// Returns whether a place is in a digit of seven segments. @param p  (0, 0) upper left corner of the digit, (1, 2)
/// lower right one
bool isInk(vec2 p, int digit) {
  const vec2 a = vec2(0.2, 0.2), b = vec2(0.8, 0.2), c = vec2(0.8, 1.0), d = vec2(0.8, 1.8), e = vec2(0.2, 1.8), f = vec2(0.2, 1.0);
  if (digit == 10) return length(p - e) < 0.15;
  if (digit > 10) return false;
  uint bits = kSegments[digit];
  return ((bits & 1u) != 0u && on(p, a, b)) || ((bits & 2u) != 0u && on(p, b, c)) || ((bits & 4u) != 0u && on(p, c, d)) ||
         ((bits & 8u) != 0u && on(p, d, e)) || ((bits & 16u) != 0u && on(p, e, f)) || ((bits & 32u) != 0u && on(p, f, a)) ||
         ((bits & 64u) != 0u && on(p, f, c));
}

void main() {
  image = vec4(0.0, 0.0, 0.0, 0.5);
  bool above = at.y < kTextHeight, below = at.y > 1.0 - kTextHeight;
  if (above || below) {
    vec2 p = vec2(4.0 * at.x, 2.0 * (above ? at.y : at.y - (1.0 - kTextHeight)) / kTextHeight);
    int column = min(int(p.x), 3);
    int digit = above ? int(digits[column]) : (column == 0 ? 0 : 11);
    if (isInk(vec2(fract(p.x), p.y), digit)) image = vec4(0.9, 0.9, 0.9, 1.0);
    return;
  }
  float share = 1.0 - (at.y - kTextHeight) / (1.0 - 2.0 * kTextHeight);
  image = vec4(linearFromSrgb(strainColor(share)), 1.0);
}
