// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force of one spring on the node at its near end (physics.md 1, 2).

const float kSqrt2 = 1.41421356237309505f;
const float kShortest = 1e-6f;  // of the rest length: a shorter spring keeps its direction at rest

struct Spring {
  vec3 direction;   // unit vector towards the far end
  float extension;  // L - l0 [m]
};

/// Returns the dot product in a fixed order: `precise` keeps the compiler from factoring or fusing, fma() specifies the fused
/// operations.
float fixedDot(vec3 a, vec3 b) {
  precise float sum = fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
  return sum;
}

/// Returns whether a lattice's spring is mild (kMildStretch). @param d, l0, w  as in springBetween()
bool isMild(vec3 d, float l0, vec3 w) {
  precise float more = fma(2.0f, fixedDot(d, w), fixedDot(w, w));
  return abs(more) < kMildStretch * (l0 * l0);
}

/// @param d  rest offset to the far end [m]   @param l0  rest length [m]   @param prestrain  d.d - l0^2 [m2], 0 in a lattice
/// @param w  u_far - u_near [m]
/// L - l0 = (2 d.w + w.w + prestrain) / (L + l0): no cancellation at small strain; antisymmetric to the bit under
/// (d, w) -> (-d, -w).
#if defined(NETWORK) || defined(PRESTRESS)
/// A spring of zero length has no direction and exerts no force.
Spring springBetween(vec3 d, float l0, float prestrain, vec3 w) {
  const float least = 1e-30f;  // [m, m2] far below any length: avoids a division by 0
  precise vec3 e = d + w;
  precise float l = sqrt(fixedDot(e, e));
  precise vec3 direction = l > max(kShortest * l0, least) ? e / l : d / sqrt(max(fixedDot(d, d), least));
  precise float extension = (fma(2.0f, fixedDot(d, w), fixedDot(w, w)) + prestrain) / max(l + l0, least);
  Spring spring = {direction, extension};
  return spring;
}
#else
Spring springBetween(vec3 d, float l0, float prestrain, vec3 w) {
  precise vec3 e = d + w;
  precise float l = sqrt(fixedDot(e, e));
  precise vec3 direction = l > kShortest * l0 ? e / l : d / l0;
  precise float extension = fma(2.0f, fixedDot(d, w), fixedDot(w, w)) / (l + l0);
  Spring spring = {direction, extension};
  return spring;
}
#endif
