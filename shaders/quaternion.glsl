// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause

/// v turned by the unit quaternion q (xyzw).
vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

vec4 conjugate(vec4 q) { return vec4(-q.xyz, q.w); }
