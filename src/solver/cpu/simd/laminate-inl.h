// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells with two materials, a vector at a time, with the names of shaders/solver/tissue/laminate.glsl. Included once
// per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAMINATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAMINATE_INL_H
#undef VISCERA_SOLVER_CPU_LAMINATE_INL_H
#else
#define VISCERA_SOLVER_CPU_LAMINATE_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/law_stress-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// One layer: its constants, then its state at its gradient F + s a N^T.
struct LawLayer {
  V s;       ///< signed share of the other layer
  V weight;  ///< share of this layer times its shear modulus, over the mean modulus
  V modulus, bulk;
  V slope;  ///< modulus times |s|: factor of the derivative of the traction by a
  V e, size, shear, kappa, off, inverse, volume_slope;
};
struct LawLaminate {
  Vec3 normal, jump;
  LawLayer a, b;
};

/// Loads the laminates of a vector of cells.
/// @param numbers  of the first cell (CpuStrengths::brick_laminates); the next number is 16 farther
HWY_INLINE LawLaminate loadLaminate(const float* numbers) {
  const V one = set(1), share_a = load(numbers + 48), share_b = hn::Sub(one, share_a);
  const V mu_a = load(numbers + 64), mu_b = load(numbers + 80);
  LawLaminate out;
  out.normal = {load(numbers), load(numbers + 16), load(numbers + 32)};
  out.a.s = share_b;
  out.a.modulus = mu_a;
  out.a.weight = hn::Mul(share_a, mu_a);
  out.a.slope = hn::Mul(mu_a, share_b);
  out.a.bulk = load(numbers + 96);
  out.b.s = hn::Neg(share_a);
  out.b.modulus = mu_b;
  out.b.weight = hn::Mul(share_b, mu_b);
  out.b.slope = hn::Mul(mu_b, share_a);
  out.b.bulk = load(numbers + 112);
  return out;
}

/// Dot products from which the jump alpha off + beta m is computed.
struct JumpPlane {
  V om, oo, mm, of, j, e, size;
};

/// Updates a layer for a jump.
/// @param by_e, by_f, square  m.a, f.a and a.a
HWY_INLINE void moveLayer(const LawBody& body, const JumpPlane& p, V by_e, V by_f, V square, LawLayer& y) {
  y.e = hn::MulAdd(y.s, by_e, p.e);
  y.size = hn::MulAdd(y.s, hn::MulAdd(set(2), by_f, hn::Mul(y.s, square)), p.size);
  const Volume v = volumeOf<true>(y.e);
  const LawParts parts = lawPartsOf<true>(y.e, y.size, v);
  y.off = parts.off;
  y.inverse = v.inverse;
  y.volume_slope = v.slope;
  y.shear = body.stiffens ? hn::Mul(v.phi, stifferAt(body, shearOf(v.phi, y.size))) : v.phi;
  const V pressure = hn::Mul(hn::Mul(set(0.5f), y.bulk), hn::Add(y.e, parts.squeezed));
  y.kappa = hn::NegMulAdd(y.shear, y.off, pressure);
}

/// Returns the derivatives of a layer's kappa and shear along a change of a, over s: by_e is m.da, by_f is f.da.
HWY_INLINE V kappaAlong(const LawLayer& y, V by_e, V by_f) {
  const V one = set(1), of_shear = hn::Mul(y.shear, y.inverse);
  const V of_e = hn::MulAdd(hn::Mul(set(0.5f), y.bulk), hn::MulAdd(y.inverse, y.inverse, one),
                            hn::Mul(of_shear, hn::MulAdd(set(5.0f / 3), y.off, one)));
  return hn::NegMulAdd(hn::Mul(set(2.0f / 3), of_shear), by_f, hn::Mul(of_e, by_e));
}
HWY_INLINE V shearAlong(const LawLayer& y, V by_e) {
  return hn::Mul(hn::Mul(set(-2.0f / 3), y.shear), hn::Mul(y.volume_slope, by_e));
}

/// Returns the share of a step in which a layer loses no more than 0.7 of its volume.
HWY_INLINE V partOfStep(const LawLayer& y, V gains) {
  const V one = set(1), most = hn::Max(hn::Mul(set(0.7f), hn::Add(one, y.e)), set(0.1f));
  const V loses = hn::Neg(hn::Mul(y.s, gains));
  return hn::Min(one, hn::Div(most, hn::Max(loses, set(1e-20f))));
}

/// A layer's traction along off and m over its modulus, and its derivatives by alpha and beta over s.
struct Traction {
  V off, m, off_alpha, off_beta, m_alpha, m_beta;
};
HWY_INLINE Traction tractionOf(const LawLayer& y, const JumpPlane& p, V alpha, V beta) {
  const V one = set(1), along = hn::MulAdd(y.s, alpha, one), across = hn::Mul(y.s, beta);
  const V shear_alpha = shearAlong(y, p.om), shear_beta = shearAlong(y, p.mm);
  const V f_alpha = hn::MulAdd(y.s, hn::MulAdd(alpha, p.oo, hn::Mul(beta, p.om)), p.of);
  return {hn::Mul(y.shear, along),
          hn::MulAdd(y.shear, across, y.kappa),
          hn::MulAdd(shear_alpha, along, y.shear),
          hn::Mul(shear_beta, along),
          hn::MulAdd(shear_alpha, across, kappaAlong(y, p.om, f_alpha)),
          hn::MulAdd(shear_beta, across, hn::Add(kappaAlong(y, p.mm, hn::Add(one, y.e)), y.shear))};
}

/// Makes one step of Newton's method for alpha and beta.
HWY_INLINE void stepJump(const LawLaminate& l, const JumpPlane& p, V& alpha, V& beta) {
  const Traction a = tractionOf(l.a, p, alpha, beta), b = tractionOf(l.b, p, alpha, beta);
  const auto differ = [&](V of_a, V of_b)
                          HWY_ATTR { return hn::Sub(hn::Mul(l.a.modulus, of_a), hn::Mul(l.b.modulus, of_b)); };
  const auto sum = [&](V of_a, V of_b) HWY_ATTR { return hn::MulAdd(l.a.slope, of_a, hn::Mul(l.b.slope, of_b)); };
  const V off = differ(a.off, b.off), m = differ(a.m, b.m);
  const V oa = sum(a.off_alpha, b.off_alpha), ob = sum(a.off_beta, b.off_beta);
  const V ma = sum(a.m_alpha, b.m_alpha), mb = sum(a.m_beta, b.m_beta);
  const V per = hn::Div(set(1), hn::Max(hn::MulSub(oa, mb, hn::Mul(ob, ma)), set(1e-6f)));
  const V by_alpha = hn::Mul(per, hn::MulSub(ob, m, hn::Mul(mb, off)));
  const V by_beta = hn::Mul(per, hn::MulSub(ma, off, hn::Mul(oa, m)));
  const V gains = hn::MulAdd(by_alpha, p.om, hn::Mul(by_beta, p.mm));
  const V part = hn::Min(partOfStep(l.a, gains), partOfStep(l.b, gains));
  alpha = hn::MulAdd(part, by_alpha, alpha);
  beta = hn::MulAdd(part, by_beta, beta);
}

/// Updates a laminate's layers for the jump at which their tractions are equal.
/// @param d, c, e  mean gradient minus 1, its cofactors minus 1 and its dilation
inline HWY_NOINLINE void findJump(const LawBody& body, const Columns& d, const Columns& c, V e, LawLaminate& l) {
  const Vec3& n = l.normal;
  const Vec3 m = timesOf(c, n), off = mulAdd(n.x, d.a - c.a, mulAdd(n.y, d.b - c.b, n.z * (d.c - c.c)));
  JumpPlane p;
  p.om = dot(off, m);
  p.oo = dot(off, off);
  p.mm = hn::Max(dot(m, m), set(1e-6f));
  p.of = hn::Add(p.oo, p.om);
  p.j = hn::Add(e, set(1));
  p.e = e;
  p.size = sizeOf(d);
  V alpha = hn::Div(hn::Sub(l.b.modulus, l.a.modulus), hn::Add(l.a.slope, l.b.slope));
  V beta = hn::Neg(hn::Div(hn::Mul(alpha, p.om), p.mm));
  for (int step = 0;; ++step) {
    const V by_e = hn::MulAdd(alpha, p.om, hn::Mul(beta, p.mm)), by_f = hn::MulAdd(alpha, p.of, hn::Mul(beta, p.j));
    const V mixed = hn::Mul(hn::Mul(set(2), hn::Mul(alpha, beta)), p.om);
    const V square = hn::MulAdd(hn::Mul(alpha, alpha), p.oo, hn::MulAdd(hn::Mul(beta, beta), p.mm, mixed));
    moveLayer(body, p, by_e, by_f, square, l.a);
    moveLayer(body, p, by_e, by_f, square, l.b);
    if (step == layout::kLaminateSteps) break;
    stepJump(l, p, alpha, beta);
  }
  l.jump = mulAdd(alpha, off, beta * m);
}

/// Returns what a N^T adds to F and to its cofactors.
HWY_INLINE Columns jumpColumns(const LawLaminate& l) {
  return {l.normal.x * l.jump, l.normal.y * l.jump, l.normal.z * l.jump};
}
HWY_INLINE Columns jumpCofactors(const LawLaminate& l, const Columns& d) {
  const V one = set(1);
  const Vec3 fa = {hn::Add(d.a.x, one), d.a.y, d.a.z}, fb = {d.b.x, hn::Add(d.b.y, one), d.b.z};
  const Vec3 fc = {d.c.x, d.c.y, hn::Add(d.c.z, one)};
  const Vec3& n = l.normal;
  return {cross(l.jump, n.y * fc - n.z * fb), cross(l.jump, n.z * fa - n.x * fc), cross(l.jump, n.x * fb - n.y * fa)};
}

/// Returns mu dW/dF of both layers.
/// @param numbers  as for loadLaminate()
/// @param c, e  cofactors minus 1 and dilation of d
inline HWY_NOINLINE Columns laminateStress(const LawBody& body, const float* numbers, V mu, const Columns& d,
                                           const Columns& c, V e) {
  LawLaminate l = loadLaminate(numbers);
  findJump(body, d, c, e, l);
  const auto sum = [&](V of_a, V of_b) HWY_ATTR { return hn::Mul(mu, hn::Add(of_a, of_b)); };
  const V shear_a = hn::Mul(l.a.weight, l.a.shear), shear_b = hn::Mul(l.b.weight, l.b.shear);
  const V turn_a = hn::MulSub(l.a.weight, l.a.kappa, shear_a), turn_b = hn::MulSub(l.b.weight, l.b.kappa, shear_b);
  const V shear = sum(shear_a, shear_b), of_jump = sum(hn::Mul(l.a.s, shear_a), hn::Mul(l.b.s, shear_b));
  const V of_c = sum(turn_a, turn_b), of_turn = sum(hn::Mul(l.a.s, turn_a), hn::Mul(l.b.s, turn_b));
  const Columns by = jumpColumns(l), turn = jumpCofactors(l, d);
  const auto of = [&](const Vec3& d1, const Vec3& by1, const Vec3& c1, const Vec3& turn1)
                      HWY_ATTR { return mulAdd(shear, d1, mulAdd(of_jump, by1, mulAdd(of_c, c1, of_turn * turn1))); };
  Columns p = {of(d.a, by.a, c.a, turn.a), of(d.b, by.b, c.b, turn.b), of(d.c, by.c, c.c, turn.c)};
  const V kappa = sum(hn::Mul(l.a.weight, l.a.kappa), hn::Mul(l.b.weight, l.b.kappa));
  p.a.x = hn::Add(p.a.x, kappa);
  p.b.y = hn::Add(p.b.y, kappa);
  p.c.z = hn::Add(p.c.z, kappa);
  return p;
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
