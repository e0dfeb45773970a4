// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// g_buffer_code.glsl - encoding of the samples of tissue_g_buffer.frag, which deferred_lighting.frag reads.

/// Encodes a unit vector in three times 10 bits, and a bit for a front face.
uint directionCode(vec3 n, bool front) {
  uvec3 of = uvec3(clamp(n, -1.0, 1.0) * 511.0 + 512.5);
  return of.x | of.y << 10 | of.z << 20 | (front ? 1u << 30 : 0u);
}

vec3 directionOf(uint code) { return vec3(ivec3(code & 1023u, code >> 10 & 1023u, code >> 20 & 1023u) - 512); }  // not of unit length

bool isFront(uint code) { return (code >> 30 & 1u) == 1u; }

/// Returns the alpha of the vertices: wall or surface, and the body.
float alphaOf(uint finish) { return float(finish >> 24) / 255.0; }
