// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force of a spring, a vector of springs at a time. Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_SPRINGS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_SPRINGS_INL_H
#undef VISCERA_SOLVER_CPU_SPRINGS_INL_H
#else
#define VISCERA_SOLVER_CPU_SPRINGS_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/tiles-inl.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

// With q = (L^2 - l0^2) / l0^2, computed without cancellation, the force of a spring on its near end is k (L - l0)/L e
// = k q phi(q) e. Here phi(q) = 1 / (1 + q + sqrt(1 + q)) and e is the vector to the far end (physics.md 1, 2). Below
// kShortest of its rest length a spring keeps its direction at rest (shaders/solver/tissue/spring.glsl).
constexpr float kShortest2 = 1e-12f;

/// Computes phi for any q > -1. Where the processor's estimates of 1/sqrt(4 x) and 1/(4 x + 4 sqrt(x)), x = 1 + q, have
/// at least 12 bits, one Newton step refines each; elsewhere it is exact.
HWY_INLINE V anyPhi(V q) {
  const V x4 = hn::Max(hn::MulAdd(q, set(4), set(4)), set(1e-24f));
#if HWY_ARCH_X86
  const V estimate = hn::ApproximateReciprocalSqrt(x4);
  const V t = hn::Mul(x4, estimate);
  const V d4 = hn::MulAdd(t, hn::NegMulAdd(t, estimate, set(3)), x4);
  const V r = hn::ApproximateReciprocal(d4);
  return hn::Mul(hn::Mul(set(4), r), hn::NegMulAdd(d4, r, set(2)));
#else
  return hn::Div(set(4), hn::MulAdd(set(2), hn::Sqrt(x4), x4));
#endif
}

/// Force of a spring on its near end: pull e. The force on the far end is the opposite.
struct SpringPull {
  V pull;  ///< force over length, N/m
  Vec3 e;  ///< vector to the far end [m]
};
/// Computes the force of the springs in direction (X, Y, Z).
/// @param w  u_far - u_near
/// @param dv  v_far - v_near
/// @param largest  largest |q| so far, updated
/// @tparam kUniform  all springs exist
/// @tparam kAny  springs may have any length; otherwise |q| < kMild
template <int X, int Y, int Z, bool kUniform, bool kAny, bool kDashpot>
HWY_INLINE SpringPull springPull(const Material& m, V k, const Vec3& w, const Vec3& dv, V& largest) {
  constexpr int kKind = X * X + Y * Y + Z * Z - 1;
  V q = hn::Mul(dot(w, shifted<X, Y, Z>(w, m.h2)), m.per_length2[kKind]);
  // Absent springs must not decide whether the others are mild, and no power of q may be infinite.
  if (!kUniform) q = hn::IfThenElseZero(hn::Gt(k, hn::Zero(Tag())), q);
  largest = hn::Max(largest, hn::Abs(q));
  Vec3 e = shifted<X, Y, Z>(w, m.h);
  V phi;
  if (kAny) {
    phi = anyPhi(q);
    const V x = hn::Add(set(1), q);
    const M collapsed = hn::Lt(x, set(kShortest2));
    if (HWY_UNLIKELY(!hn::AllFalse(Tag(), collapsed))) {  // force k (L - l0) along the direction at rest
      // Makes q phi equal to (L - l0) / l0 and e, of length l0, the direction.
      phi = hn::IfThenElse(collapsed, set(1), phi);
      e = select(collapsed, shifted<X, Y, Z>(zero3(), m.h), e);
    }
  } else {
    phi = mildPhi(q);
  }
  V c = hn::Mul(q, phi);
  if (kDashpot) {
    V ratio = hn::NegMulAdd(q, phi, set(1));  // l0 / L; 1 where e is the direction at rest
    if (kAny) ratio = hn::IfThenElse(hn::Lt(hn::Add(set(1), q), set(kShortest2)), set(1), ratio);
    c = hn::MulAdd(hn::Mul(dot(dv, e), m.dashpot_length2[kKind]), hn::Mul(ratio, ratio), c);
  }
  return {hn::Mul(k, c), e};
}

/// Current relative displacement and velocity of the ends of springs, far minus near [m, m/s].
struct Apart {
  Vec3 u, v;
};
/// Computes the same with dashpots. Mild springs use the predicted positions of nodes, the others the current positions
/// and velocities (shaders/solver/step/leapfrog.comp).
/// @param w  relative displacement at the predicted positions
/// @param now  returns Apart
template <int X, int Y, int Z, class Now>
HWY_INLINE SpringPull predictedPull(const Material& m, V k, const Vec3& w, const Now& now, V& largest) {
  V stretch = hn::Zero(Tag());
  const SpringPull soon = springPull<X, Y, Z, false, false, false>(m, k, w, zero3(), stretch);
  largest = hn::Max(largest, stretch);
  const M strained = hn::Ge(stretch, set(kMild));
  if (hn::AllFalse(Tag(), strained)) return soon;
  const Apart apart = now();
  const SpringPull pull = springPull<X, Y, Z, false, true, true>(m, k, apart.u, apart.v, stretch);
  return {hn::IfThenElse(strained, pull.pull, soon.pull), select(strained, pull.e, soon.e)};
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
