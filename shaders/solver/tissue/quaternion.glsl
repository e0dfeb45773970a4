// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef QUATERNION_GLSL
#define QUATERNION_GLSL

/// Returns v rotated by the unit quaternion q (xyzw).
vec3 rotated(vec4 q, vec3 v) { return v + 2.0f * cross(xyz(q), cross(xyz(q), v) + q.w * v); }

vec4 conjugate(vec4 q) { return vec4(-xyz(q), q.w); }
#endif
