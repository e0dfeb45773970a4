// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// seen_code.glsl - what tissue_seen.frag says of a pixel, in few words.   For seen_light.frag to read.

/// A unit vector in three times 10 bits, and a bit that says whether it is of a front.
uint directionCode(vec3 n, bool front) {
  uvec3 of = uvec3(clamp(n, -1.0, 1.0) * 511.0 + 512.5);
  return of.x | of.y << 10 | of.z << 20 | (front ? 1u << 30 : 0u);
}

vec3 directionOf(uint code) { return vec3(ivec3(code & 1023u, code >> 10 & 1023u, code >> 20 & 1023u) - 512); }  // not of unit length

bool isFront(uint code) { return (code >> 30 & 1u) == 1u; }

/// Wall or skin, and whose: as the alpha of the vertices.
float alphaOf(uint finish) { return float(finish >> 24) / 255.0; }
