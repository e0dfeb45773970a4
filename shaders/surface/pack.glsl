// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Unit normals as three signed 10-bit fractions in a uint, x in the low bits (GL_INT_2_10_10_10_REV). Never kept in a
// float: drivers may flush or quieten its bits. Must agree with surface/skins/normal_packing.cpp.
const float kPackedOne = 511.0f;

uint packNormal(vec3 normal) {
  ivec3 q = ivec3(floor(clamp(normal, -1.0f, 1.0f) * kPackedOne + 0.5f));
  uvec3 bits = uvec3(q) & 1023u;
  return bits.x | bits.y << 10 | bits.z << 20;
}

#ifndef __cplusplus
vec3 unpackNormal(uint packed_normal) {
  int bits = int(packed_normal);
  ivec3 q = ivec3(bitfieldExtract(bits, 0, 10), bitfieldExtract(bits, 10, 10), bitfieldExtract(bits, 20, 10));
  return vec3(q) / kPackedOne;
}
#endif
