// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Density and stress of the neo-Hookean law, a vector of cells at a time, with the names of
// shaders/solver/tissue/law.glsl. Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAW_STRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAW_STRESS_INL_H
#undef VISCERA_SOLVER_CPU_LAW_STRESS_INL_H
#else
#define VISCERA_SOLVER_CPU_LAW_STRESS_INL_H
#endif

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "layout/law.h"
#include "solver/cpu/simd/cell_modes-inl.h"
#include "solver/cpu/simd/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kMostExponent, layout::kLawAlternating, layout::kLeastVolume, layout::kMostStiffening;

/// Constants of a body over mu, in all lanes.
struct LawBody {
  V per_4h;                ///< 1 / (4 h): turns a rigidity [J] into a force [N]
  V bulk;                  ///< K / mu
  V along, aside;          ///< plane stress over 3, the factor for the second moments of full cells
  V poisson;               ///< lambda / (lambda + 2 mu)
  V stiffening;            ///< b
  bool stiffens;           ///< b is not 0
  float scale, dashpot_s;  ///< 1 / (4 h); dashpot time [s], 0 without a dashpot
};
/// Returns the constants of a body.
/// @param ratio  lambda/mu - 1
HWY_INLINE LawBody lawBodyOf(const layout::BodyParams& body, V ratio, bool dashpot) {
  const V lambda = hn::Add(ratio, set(1)), per = hn::Div(set(1), hn::Add(lambda, set(2)));
  const float scale = 0.25f / body.origin_spacing.w;
  return {set(scale),
          hn::Add(lambda, set(2.0f / 3)),
          hn::Mul(set(4.0f / 3), hn::Mul(hn::Add(lambda, set(1)), per)),
          hn::Mul(set(2.0f / 3), hn::Mul(lambda, per)),
          hn::Mul(lambda, per),
          set(body.stiffening),
          body.stiffening != 0,
          scale,
          dashpot ? body.dashpot_s : 0};
}

/// Columns of a 3x3 matrix.
struct Columns {
  Vec3 a, b, c;
};

HWY_INLINE V minorOf(V p, V q, V r, V s, V t) {  // p q - (r s + t)
  return hn::MulSub(p, q, hn::MulAdd(r, s, t));
}
HWY_INLINE V ownMinorOf(V p, V q, V r, V s) {  // (1 + p)(1 + q) - 1 - r s
  return hn::NegMulAdd(r, s, hn::Add(hn::MulAdd(p, q, p), q));
}
/// Computes cof(1 + D) - 1 without cancellation.
HWY_INLINE Columns cofactorsOf(const Columns& d) {
  const Vec3 &a = d.a, &b = d.b, &c = d.c;
  return {{ownMinorOf(b.y, c.z, b.z, c.y), minorOf(b.z, c.x, b.x, c.z, b.x), minorOf(b.x, c.y, b.y, c.x, c.x)},
          {minorOf(c.y, a.z, c.z, a.y, a.y), ownMinorOf(c.z, a.x, c.x, a.z), minorOf(c.x, a.y, c.y, a.x, c.y)},
          {minorOf(a.y, b.z, a.z, b.y, a.z), minorOf(a.z, b.x, a.x, b.z, b.z), ownMinorOf(a.x, b.y, a.y, b.x)}};
}
/// Computes det(1 + D) - 1.
/// @param c  cofactorsOf(d)
HWY_INLINE V dilationOf(const Columns& d, const Columns& c) {
  return hn::MulAdd(d.a.x, c.a.x, hn::MulAdd(d.a.y, c.a.y, hn::MulAdd(d.a.z, c.a.z, hn::Add(d.a.x, c.a.x))));
}
/// Computes (1 + M) v and (1 + M)^T v.
HWY_INLINE Vec3 timesOf(const Columns& m, const Vec3& v) {
  return mulAdd(v.x, m.a, mulAdd(v.y, m.b, mulAdd(v.z, m.c, v)));
}
HWY_INLINE Vec3 transposedOf(const Columns& m, const Vec3& v) {
  const auto of = [&](const Vec3& column, V own) HWY_ATTR {
    return hn::MulAdd(column.x, v.x, hn::MulAdd(column.y, v.y, hn::MulAdd(column.z, v.z, own)));
  };
  return {of(m.a, v.x), of(m.b, v.y), of(m.c, v.z)};
}
/// Returns p + x a + y b + z c.
HWY_INLINE Vec3 plusThree(const Vec3& p, const Vec3& x, V a, const Vec3& y, V b, const Vec3& z, V c) {
  return mulAdd(a, x, mulAdd(b, y, mulAdd(c, z, p)));
}
/// Returns p - x a - y b - z c.
HWY_INLINE Vec3 minusThree(const Vec3& p, const Vec3& x, V a, const Vec3& y, V b, const Vec3& z, V c) {
  const auto of = [&](V p1, V x1, V y1, V z1)
                      HWY_ATTR { return hn::NegMulAdd(x1, a, hn::NegMulAdd(y1, b, hn::NegMulAdd(z1, c, p1))); };
  return {of(p.x, x.x, y.x, z.x), of(p.y, x.y, y.y, z.y), of(p.z, x.z, y.z, z.z)};
}

/// The functions of J = 1 + e in W: phi = J^(-2/3), its slope as -3/2 phi'/phi, and 1/J.
struct Volume {
  V phi, slope, inverse;
};
/// Evaluates the functions of J.
/// @tparam kAny  J may be less than kLeastVolume
template <bool kAny>
HWY_INLINE Volume volumeOf(V e) {
  const hn::RebindToSigned<Tag> di;
  const V one = set(1), least = set(kLeastVolume), here = hn::Add(e, one), j = hn::Max(here, least);
  // J^(-1/3): a first guess from the bits, within 4 %, then two steps t (1 + k/3 + 2 k^2/9), k = 1 - J t^3.
  const V third = hn::Mul(hn::ConvertTo(Tag(), hn::BitCast(di, j)), set(1.0f / 3));
  V t = hn::BitCast(Tag(), hn::Sub(hn::Set(di, 0x54a21d2a), hn::NearestInt(third)));
  for (int i = 0; i < 2; ++i) {
    const V k = hn::NegMulAdd(hn::Mul(j, t), hn::Mul(t, t), one);
    t = hn::MulAdd(hn::Mul(t, k), hn::MulAdd(k, set(2.0f / 9), set(1.0f / 3)), t);
  }
  Volume v;
  v.phi = hn::Mul(t, t);
  v.inverse = v.slope = hn::Mul(v.phi, t);
  if constexpr (kAny) {
    const M below = hn::Lt(here, least);
    const V rest = hn::Sub(hn::Add(least, least), here);
    const V grown = hn::MulAdd(set(2.0f / 3), hn::Div(hn::Sub(least, here), hn::Max(rest, least)), one);
    v.slope = hn::IfThenElse(below, hn::Div(least, hn::Mul(hn::Mul(rest, rest), grown)), v.slope);
    v.phi = hn::IfThenElse(below, hn::Mul(v.phi, grown), v.phi);
  }
  return v;
}

/// Returns |1 + D|^2 - 3.
HWY_INLINE V sizeOf(const Columns& d) {
  const V trace = hn::Add(d.a.x, hn::Add(d.b.y, d.c.z));
  return hn::MulAdd(set(2), trace, hn::Add(dot(d.a, d.a), hn::Add(dot(d.b, d.b), dot(d.c, d.c))));
}

/// Returns x of the stiffening law.
/// @param size  |F|^2 - 3
HWY_INLINE V shearOf(V phi, V size) {
  return hn::MulSub(phi, hn::Add(size, set(3)), set(3));
}
/// Returns the factor by which the shear modulus grows at x.
inline HWY_NOINLINE V stifferAt(const LawBody& body, V x) {
  return hn::Exp(Tag(), hn::Min(hn::Mul(body.stiffening, x), set(kMostExponent)));
}

/// Coefficients of shear and pressure at a volume and a size: dW/dF = shear (F - C) + kappa C over mu, C = cof F, kappa
/// = K/2 (e + squeezed) - shear off.
struct LawParts {
  V off, squeezed;
};
/// Computes these coefficients.
/// @tparam kAny  J may be less than kLeastVolume
/// @param v  functions of e
/// @param size  |F|^2 - 3
template <bool kAny>
HWY_INLINE LawParts lawPartsOf(V e, V size, const Volume& v) {
  const V third = set(1.0f / 3), one = set(1);
  LawParts out = {hn::Mul(hn::MulSub(third, size, e), v.inverse), hn::Mul(e, v.inverse)};
  if constexpr (kAny) {
    const M below = hn::Lt(hn::Add(e, one), set(kLeastVolume));
    out.off = hn::IfThenElse(below, hn::MulSub(v.slope, hn::MulAdd(third, size, one), one), out.off);
    out.squeezed = hn::IfThenElse(below, hn::Sub(one, v.inverse), out.squeezed);
  }
  return out;
}

/// Returns mu dW/dF.
/// @param c, e, v  cofactors minus 1, dilation and functions of J of d
template <bool kAny>
HWY_INLINE Columns lawStress(const LawBody& body, V mu, const Columns& d, const Columns& c, V e, const Volume& v) {
  const V size = sizeOf(d);
  const LawParts parts = lawPartsOf<kAny>(e, size, v);
  V scale = hn::Mul(mu, v.phi);
  if (HWY_UNLIKELY(body.stiffens)) scale = hn::Mul(scale, stifferAt(body, shearOf(v.phi, size)));
  const V pressure = hn::Mul(hn::Mul(hn::Mul(set(0.5f), body.bulk), mu), hn::Add(e, parts.squeezed));
  const V kappa = hn::NegMulAdd(scale, parts.off, pressure), rest = hn::Sub(kappa, scale);
  Columns p = {mulAdd(rest, c.a, scale * d.a), mulAdd(rest, c.b, scale * d.b), mulAdd(rest, c.c, scale * d.c)};
  p.a.x = hn::Add(p.a.x, kappa);
  p.b.y = hn::Add(p.b.y, kappa);
  p.c.z = hn::Add(p.c.z, kappa);
  return p;
}

/// A cell's prestress over mu: xx, yy, zz; yz, zx, xy.
struct LawTension {
  Vec3 pulled, sheared;
};
/// Loads the prestress of a vector of cells.
/// @param numbers  of the first cell; the next number is 16 farther
HWY_INLINE LawTension loadTension(const float* numbers) {
  return {{load(numbers), load(numbers + 16), load(numbers + 32)},
          {load(numbers + 48), load(numbers + 64), load(numbers + 80)}};
}
/// Returns the columns of F S.
HWY_INLINE Columns tensionAt(const LawTension& t, const Columns& d) {
  return {timesOf(d, {t.pulled.x, t.sheared.z, t.sheared.y}), timesOf(d, {t.sheared.z, t.pulled.y, t.sheared.x}),
          timesOf(d, {t.sheared.y, t.sheared.x, t.pulled.z})};
}
/// Adds mu F S to mu dW/dF.
/// @param tension  as for loadTension()
inline HWY_NOINLINE void addTension(const float* tension, V mu, const Columns& d, Columns& p) {
  const Columns f = tensionAt(loadTension(tension), d);
  p = {mulAdd(mu, f.a, p.a), mulAdd(mu, f.b, p.b), mulAdd(mu, f.c, p.c)};
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
