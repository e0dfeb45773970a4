// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tangents of springs, T = s s^T + t 1, as s and t [sqrt(N/m), N/m] in the upper halves of float32, rounded: they are read far
// more often than they are needed to more than three digits. After multigrid.glsl.
layout(std430, binding = kBindTangents) buffer TangentsBuffer { uvec2 tangents[]; };

uint upperHalf(float x) { return (floatBitsToUint(x) + 0x8000u) >> 16; }
uvec2 packTangent(vec3 s, float t) { return uvec2(upperHalf(s.x) | upperHalf(s.y) << 16, upperHalf(s.z) | upperHalf(t) << 16); }

/// T d of an even spring of its owner.
vec3 springTimes(uint owner, uint pair, vec3 d) {
  uvec2 words = tangents[pair * slot_count + owner];
  vec3 s = vec3(uintBitsToFloat(words.x << 16), uintBitsToFloat(words.x & 0xffff0000u), uintBitsToFloat(words.y << 16));
  return dot(s, d) * s + uintBitsToFloat(words.y & 0xffff0000u) * d;
}
