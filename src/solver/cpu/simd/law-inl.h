// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neo-Hookean law, a vector of cells at a time, with the names of shaders/solver/tissue/law.glsl. Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAW_INL_H
#undef VISCERA_SOLVER_CPU_LAW_INL_H
#else
#define VISCERA_SOLVER_CPU_LAW_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/laminate-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

// Displacements are scaled by 1 / (4 h) when they are loaded, so that the modes of a cell are plain sums: D of the mean
// edges, half of the hourglass motions H, and a fourth of T = sqrt(8) H_xyz.

/// s of three hourglass motions: components along the frame's axes.
struct Curvatures {
  Vec3 x, y, z;
};
/// Moments of a cell's tissue: twice its centroid, and four times the second moments about it.
struct LawMoments {
  Vec3 centroid2, square, mixed;
};

/// Computes the derivatives of s.K.s/2 by s over mu.
/// @tparam kFull  all cells are full; `m` is not read
template <bool kFull>
HWY_INLINE Curvatures lawBends(const LawBody& body, const LawMoments& m, const Curvatures& s) {
  if constexpr (kFull) {
    const auto of = [&](V own, V other) HWY_ATTR { return hn::MulAdd(body.along, own, hn::Mul(body.aside, other)); };
    const V third = set(1.0f / 3), trace = hn::Add(s.x.x, hn::Add(s.y.y, s.z.z));
    const auto even = [&](V own) HWY_ATTR { return hn::Mul(third, hn::Add(own, trace)); };
    return {{even(s.x.x), of(s.x.y, s.y.x), of(s.x.z, s.z.x)},
            {of(s.y.x, s.x.y), even(s.y.y), of(s.y.z, s.z.y)},
            {of(s.z.x, s.x.z), of(s.z.y, s.y.z), even(s.z.z)}};
  } else {
    const Vec3 gx = {s.z.y, s.y.z, hn::Add(s.y.y, s.z.z)}, gy = {s.x.z, s.z.x, hn::Add(s.z.z, s.x.x)};
    const Vec3 gz = {s.y.x, s.x.y, hn::Add(s.x.x, s.y.y)};
    const V minus = hn::Neg(body.poisson), along = hn::Mul(set(3), body.along), aside = hn::Mul(set(3), body.aside);
    const Vec3 dx = {hn::Mul(minus, hn::Add(gx.x, gx.y)), gx.x, gx.y};
    const Vec3 dy = {gy.y, hn::Mul(minus, hn::Add(gy.x, gy.y)), gy.x};
    const Vec3 dz = {gz.x, gz.y, hn::Mul(minus, hn::Add(gz.x, gz.y))};
    const Vec3 &r = m.square, &q = m.mixed;
    const auto sum = [](V x, V a, V y, V b, V z, V c)
                         HWY_ATTR { return hn::MulAdd(x, a, hn::MulAdd(y, b, hn::Mul(z, c))); };
    const auto stress = [&](V p, V o, V twist) HWY_ATTR {
      return Vec3{hn::MulAdd(along, p, hn::Mul(aside, o)), hn::MulAdd(along, o, hn::Mul(aside, p)), twist};
    };
    const Vec3 bx =
        stress(sum(r.x, dx.y, q.z, dy.y, q.y, dz.y), sum(r.x, dx.z, q.z, dy.z, q.y, dz.z), hn::Mul(r.x, gx.z));
    const Vec3 by =
        stress(sum(q.z, dx.z, r.y, dy.z, q.x, dz.z), sum(q.z, dx.x, r.y, dy.x, q.x, dz.x), hn::Mul(r.y, gy.z));
    const Vec3 bz =
        stress(sum(q.y, dx.x, q.x, dy.x, r.z, dz.x), sum(q.y, dx.y, q.x, dy.y, r.z, dz.y), hn::Mul(r.z, gz.z));
    return {{hn::Add(by.z, bz.z), bz.y, by.x}, {bz.x, hn::Add(bz.z, bx.z), bx.y}, {by.y, bx.x, hn::Add(bx.z, by.z)}};
  }
}

/// Returns the columns of G in F* = F (1 + G).
/// @param c2  twice the centroid
HWY_INLINE Columns atCentroid(V poisson, const Curvatures& s, const Vec3& c2) {
  const auto two = [](V x, V a, V y, V b) HWY_ATTR { return hn::MulAdd(x, a, hn::Mul(y, b)); };
  const V px = hn::Mul(poisson, c2.x), py = hn::Mul(poisson, c2.y), pz = hn::Mul(poisson, c2.z);
  return {{hn::NegMulAdd(px, hn::Add(s.z.y, s.y.z), two(s.z.x, c2.y, s.y.x, c2.z)),
           hn::NegMulAdd(c2.x, s.z.x, two(s.z.y, c2.y, s.y.y, c2.z)),
           hn::NegMulAdd(c2.x, s.y.x, two(s.z.z, c2.y, s.y.z, c2.z))},
          {hn::NegMulAdd(c2.y, s.z.y, two(s.x.x, c2.z, s.z.x, c2.x)),
           hn::NegMulAdd(py, hn::Add(s.x.z, s.z.x), two(s.x.y, c2.z, s.z.y, c2.x)),
           hn::NegMulAdd(c2.y, s.x.y, two(s.x.z, c2.z, s.z.z, c2.x))},
          {hn::NegMulAdd(c2.z, s.y.z, two(s.y.x, c2.x, s.x.x, c2.y)),
           hn::NegMulAdd(c2.z, s.x.z, two(s.y.y, c2.x, s.x.y, c2.y)),
           hn::NegMulAdd(pz, hn::Add(s.y.x, s.x.y), two(s.y.z, c2.x, s.x.z, c2.y))}};
}
/// Adds to the derivatives by s the contribution of q = F^T dW/dF* through G.
HWY_INLINE void addAtCentroid(V poisson, const Columns& q, const Vec3& c2, Curvatures& r) {
  const auto add = [](V& to, V a, V x, V b, V y, V less)
                       HWY_ATTR { to = hn::Sub(hn::MulAdd(a, x, hn::MulAdd(b, y, to)), less); };
  const V px = hn::Mul(poisson, hn::Mul(c2.x, q.a.x)), py = hn::Mul(poisson, hn::Mul(c2.y, q.b.y));
  const V pz = hn::Mul(poisson, hn::Mul(c2.z, q.c.z));
  r.x.x = hn::MulAdd(c2.z, q.b.x, hn::MulAdd(c2.y, q.c.x, r.x.x));
  add(r.x.y, c2.z, q.b.y, c2.y, q.c.y, hn::MulAdd(c2.y, q.b.z, pz));
  add(r.x.z, c2.z, q.b.z, c2.y, q.c.z, hn::MulAdd(c2.z, q.c.y, py));
  r.y.y = hn::MulAdd(c2.z, q.a.y, hn::MulAdd(c2.x, q.c.y, r.y.y));
  add(r.y.x, c2.z, q.a.x, c2.x, q.c.x, hn::MulAdd(c2.x, q.a.z, pz));
  add(r.y.z, c2.z, q.a.z, c2.x, q.c.z, hn::MulAdd(c2.z, q.c.x, px));
  r.z.z = hn::MulAdd(c2.y, q.a.z, hn::MulAdd(c2.x, q.b.z, r.z.z));
  add(r.z.x, c2.y, q.a.x, c2.x, q.b.x, hn::MulAdd(c2.x, q.a.y, py));
  add(r.z.y, c2.y, q.a.y, c2.x, q.b.y, hn::MulAdd(c2.y, q.b.x, px));
}

/// Adds the derivatives by F through the cofactors where they do not depend on 1/J: there s is C^T H over kLeastVolume.
/// @param k  derivatives by s
HWY_INLINE Columns addCofactorPull(const Columns& p, V r, const Curvatures& k, const CellModes& q) {
  const V one = set(1);
  const Vec3 fa = {hn::Add(q.da.x, one), q.da.y, q.da.z}, fb = {q.db.x, hn::Add(q.db.y, one), q.db.z};
  const Vec3 fc = {q.dc.x, q.dc.y, hn::Add(q.dc.z, one)};
  const auto weighed = [&](V x, V y, V z) HWY_ATTR { return r * mulAdd(x, q.hx, mulAdd(y, q.hy, z * q.hz)); };
  const Vec3 wa = weighed(k.x.x, k.y.x, k.z.x), wb = weighed(k.x.y, k.y.y, k.z.y), wc = weighed(k.x.z, k.y.z, k.z.z);
  return {p.a + cross(wb, fc) + cross(fb, wc), p.b + cross(wc, fa) + cross(fc, wa),
          p.c + cross(wa, fb) + cross(fa, wb)};
}

/// Computes lawPull() of law.glsl.
/// @param mu  rigidity over 4 h [N], 0 where there is no cell
/// @param tension  as for loadTension(); null: no cell has a prestress
/// @param laminate  as for loadLaminate(); null: no cell has two materials
/// @param q  modes of displacements over 4 h
/// @param out  derivatives by them [N]
/// @tparam kFull  all cells are full; `m` is not read
/// @tparam kAny  cells may be compressed below kLeastVolume
/// @return false if kAny is needed; `out` is not set then
template <bool kFull, bool kAny>
HWY_INLINE bool lawForcesOf(const LawBody& body, const LawMoments& m, const float* tension, const float* laminate, V mu,
                            const CellModes& q, CellModes& out) {
  const V one = set(1), least = set(kLeastVolume - 1);
  const M there = hn::Gt(mu, hn::Zero(Tag()));
  const Columns d = {q.da, q.db, q.dc}, c = cofactorsOf(d);
  const V e = hn::IfThenElseZero(there, dilationOf(d, c));
  if (!kAny && HWY_UNLIKELY(!hn::AllTrue(Tag(), hn::Ge(e, least)))) return false;
  Volume v;
  if constexpr (kFull) {
    v = volumeOf<kAny>(e);
  } else {
    v.inverse = hn::Div(one, kAny ? hn::Max(hn::Add(e, one), set(kLeastVolume)) : hn::Add(e, one));
  }
  const V r = v.inverse;
  const Curvatures s = {r * transposedOf(c, q.hx), r * transposedOf(c, q.hy), r * transposedOf(c, q.hz)};
  Curvatures k = lawBends<kFull>(body, m, s);
  k = {mu * k.x, mu * k.y, mu * k.z};
  Columns p;
  if constexpr (kFull) {
    p = lawStress<kAny>(body, mu, d, c, e, v);
    if (HWY_UNLIKELY(tension != nullptr)) addTension(tension, mu, d, p);
  } else {
    const Columns g = atCentroid(body.poisson, s, m.centroid2);
    const Columns star = {timesOf(d, g.a) + d.a, timesOf(d, g.b) + d.b, timesOf(d, g.c) + d.c};
    const Columns of_star = cofactorsOf(star);
    const V e_star = hn::IfThenElseZero(there, dilationOf(star, of_star));
    if (!kAny && HWY_UNLIKELY(!hn::AllTrue(Tag(), hn::Ge(e_star, least)))) return false;
    Columns ps = HWY_UNLIKELY(laminate != nullptr)
                     ? laminateStress(body, laminate, mu, star, of_star, e_star)
                     : lawStress<kAny>(body, mu, star, of_star, e_star, volumeOf<kAny>(e_star));
    if (HWY_UNLIKELY(tension != nullptr)) addTension(tension, mu, star, ps);
    addAtCentroid(body.poisson, {transposedOf(d, ps.a), transposedOf(d, ps.b), transposedOf(d, ps.c)}, m.centroid2, k);
    p = {plusThree(ps.a, ps.a, g.a.x, ps.b, g.b.x, ps.c, g.c.x), plusThree(ps.b, ps.a, g.a.y, ps.b, g.b.y, ps.c, g.c.y),
         plusThree(ps.c, ps.a, g.a.z, ps.b, g.b.z, ps.c, g.c.z)};
  }
  // Derivative by T / 4 = H_xyz sqrt(8) / 4: twice that of H_xyz squared.
  out.hxyz = hn::Mul(set(2 * kLawAlternating), mu) * q.hxyz;
  out.hx = timesOf(c, r * k.x);
  out.hy = timesOf(c, r * k.y);
  out.hz = timesOf(c, r * k.z);
  out.da = minusThree(p.a, out.hx, s.x.x, out.hy, s.y.x, out.hz, s.z.x);
  out.db = minusThree(p.b, out.hx, s.x.y, out.hy, s.y.y, out.hz, s.z.y);
  out.dc = minusThree(p.c, out.hx, s.x.z, out.hy, s.y.z, out.hz, s.z.z);
  if constexpr (kAny) {
    const M below = hn::Lt(e, least);
    const Columns flat = addCofactorPull(p, r, k, q);
    out.da = select(below, flat.a, out.da);
    out.db = select(below, flat.b, out.db);
    out.dc = select(below, flat.c, out.dc);
  }
  return true;
}
template <bool kFull>
HWY_NOINLINE void squeezedForces(const LawBody& body, const LawMoments& m, const float* tension, const float* laminate,
                                 V mu, const CellModes& q, CellModes& out) {
  lawForcesOf<kFull, true>(body, m, tension, laminate, mu, q, out);
}
template <bool kFull>
HWY_INLINE void lawForces(const LawBody& body, const LawMoments& m, const float* tension, const float* laminate, V mu,
                          const CellModes& q, CellModes& out) {
  if (HWY_UNLIKELY((!lawForcesOf<kFull, false>(body, m, tension, laminate, mu, q, out))))
    squeezedForces<kFull>(body, m, tension, laminate, mu, q, out);
}

/// Loads the moments of a vector of cells.
/// @param numbers  of their brick (CpuStrengths)
/// @param cell  index of the vector's first cell in it
HWY_INLINE LawMoments loadLawMoments(const float* numbers, int cell) {
  const float* at = numbers + cellNumberAt(static_cast<uint32_t>(cell), 0, kMomentNumbers);
  return {{load(at), load(at + 16), load(at + 32)},
          {load(at + 48), load(at + 64), load(at + 80)},
          {load(at + 96), load(at + 112), load(at + 128)}};
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
