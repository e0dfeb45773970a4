// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells by moments, a vector of cells at a time: shaders/solver/tissue/moments.glsl, whose names these are. Included
// once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_MOMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_MOMENTS_INL_H
#undef VISCERA_SOLVER_CPU_MOMENTS_INL_H
#else
#define VISCERA_SOLVER_CPU_MOMENTS_INL_H
#endif

#include "hwy/highway.h"
#include "layout/moments.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kAlternating, layout::kFadeBend, layout::kFadeFull, layout::kFadeNone, layout::kFadeStrain2;

/// Mean edges less their rest value, over h; hourglass motions as sums and differences of displacements [m], which is
/// 2 h times those of moments.glsl and, hxyz, sqrt(8) h.
struct CellMotion {
  Vec3 da, db, dc, hx, hy, hz, hxyz;
};

/// Constants of a body's cells, in all lanes.
struct CellScale {
  V per_4h;
  V per_4h2;     ///< 1 / (2 h)^2: of products of two hourglass motions
  V bent, turn;  ///< of their squares, see kFadeBend
};
HWY_INLINE CellScale cellScale(float h) {
  const float per = 1 / (4 * h * h);
  return {set(0.25f / h), set(per), set(per / kFadeBend), set(-4 * per / kFadeBend)};
}

/// Plane stress of a material, over mu; of full cells, times their second moment.
template <bool kFull>
struct PlaneStress {
  V along, aside, poisson;
  Vec3 operator()(const Vec3& v) const {
    return {hn::MulAdd(along, v.x, hn::Mul(aside, v.y)), hn::MulAdd(along, v.y, hn::Mul(aside, v.x)),
            kFull ? hn::Mul(set(1.0f / 12), v.z) : v.z};
  }
};
/// @param ratio  lambda/mu - 1
template <bool kFull>
HWY_INLINE PlaneStress<kFull> planeStress(V ratio) {
  const float moment = kFull ? 1.0f / 12 : 1;
  const V per = hn::Div(set(1), hn::Add(ratio, set(3)));
  const V poisson = hn::Mul(hn::Add(ratio, set(1)), per);
  return {hn::Mul(set(4 * moment), hn::Mul(hn::Add(ratio, set(2)), per)), hn::Mul(set(2 * moment), poisson), poisson};
}

struct CellEdge {
  Vec3 direction;
  V shrink, strain, strain_slope, fade, fade_slope;
};

/// What the length of an edge does: `growth` is its square less 1. @tparam kStrains  strains are wanted
template <bool kStrains>
HWY_INLINE void setMildLength(CellEdge& e, V growth) {
  const V one = set(1), phi = mildPhi(growth);
  e.shrink = hn::NegMulAdd(growth, phi, one);
  if (!kStrains) return;
  const V share = hn::Mul(growth, phi);  // (length - 1) / length
  // 1/(1 + x) as a series, to 1e-8
  const V stretch = hn::NegMulAdd(growth, share, hn::Sub(growth, share));
  const V x = hn::Mul(set(1 / kFadeStrain2), hn::Mul(stretch, stretch));
  const V per = hn::NegMulAdd(x, hn::NegMulAdd(x, hn::NegMulAdd(x, hn::Sub(one, x), one), one), one);
  e.strain = hn::Mul(stretch, per);
  e.strain_slope = hn::Mul(hn::Sub(one, x), hn::Mul(per, per));
}
template <bool kStrains>
HWY_INLINE void setAnyLength(CellEdge& e, V growth) {
  const V one = set(1), size = hn::Sqrt(hn::Max(hn::Add(one, growth), set(1e-12f)));
  e.shrink = hn::Div(one, size);
  if (!kStrains) return;
  const V stretch = hn::Div(growth, hn::Add(size, one));
  const V q = hn::MulAdd(hn::Mul(stretch, stretch), set(1 / kFadeStrain2), one), per = hn::Div(one, q);
  e.strain = hn::Mul(stretch, per);
  e.strain_slope = hn::Mul(hn::Sub(set(2), q), hn::Mul(per, per));
}
HWY_INLINE void setFade(CellEdge& e, V growth) {
  const float kPer = 1 / (kFadeFull - kFadeNone);
  const V one = set(1), size = hn::Sqrt(hn::Max(hn::Add(one, growth), set(1e-12f)));
  const V t = hn::Min(hn::Max(hn::Mul(hn::Sub(size, set(kFadeNone)), set(kPer)), hn::Zero(Tag())), one);
  e.fade = hn::Mul(hn::Mul(t, t), hn::NegMulAdd(set(2), t, set(3)));
  e.fade_slope = hn::Mul(set(6 * kPer), hn::Mul(t, hn::Sub(one, t)));
}

/// @return some edge is so short that the energy fades; else fades are not set
template <bool kStrains>
HWY_INLINE bool cellEdges(const CellMotion& q, CellEdge (&e)[3]) {
  const V one = set(1);
  e[0].direction = {hn::Add(q.da.x, one), q.da.y, q.da.z};
  e[1].direction = {q.db.x, hn::Add(q.db.y, one), q.db.z};
  e[2].direction = {q.dc.x, q.dc.y, hn::Add(q.dc.z, one)};
  const V growth[3] = {hn::MulAdd(set(2), q.da.x, dot(q.da, q.da)), hn::MulAdd(set(2), q.db.y, dot(q.db, q.db)),
                       hn::MulAdd(set(2), q.dc.z, dot(q.dc, q.dc))};
  const V least = hn::Min(growth[0], hn::Min(growth[1], growth[2]));
  const V most = hn::Max(growth[0], hn::Max(growth[1], growth[2]));
  const bool mild = hn::AllTrue(Tag(), hn::Lt(hn::Max(most, hn::Neg(least)), set(kMild)));
  for (int i = 0; i < 3; ++i) {
    if (HWY_LIKELY(mild))
      setMildLength<kStrains>(e[i], growth[i]);
    else
      setAnyLength<kStrains>(e[i], growth[i]);
    e[i].direction = e[i].shrink * e[i].direction;
  }
  if (HWY_LIKELY(hn::AllFalse(Tag(), hn::Lt(least, set(kFadeFull * kFadeFull - 1))))) return false;
  for (int i = 0; i < 3; ++i) setFade(e[i], growth[i]);
  return true;
}

/// Of a pull by an edge's direction, its pull by the edge, over 4 h.
HWY_INLINE Vec3 edgePull(const CellEdge& e, V per_4h, const Vec3& by_direction) {
  const Vec3 across = mulAdd(hn::Neg(dot(e.direction, by_direction)), e.direction, by_direction);
  return hn::Mul(per_4h, e.shrink) * across;
}

/// Moments of cells over their shares, the first times 2 h; those of full ones are constants.
struct Moments {
  Vec3 first, square, mixed;
};
/// @param numbers  of their brick   @param cell  index of the vector's first cell in it
HWY_INLINE Moments loadMoments(const float* numbers, int cell) {
  const float* at = numbers + cellNumberAt(static_cast<uint32_t>(cell), 0, kMomentNumbers);
  return {{load(at), load(at + 16), load(at + 32)},
          {load(at + 48), load(at + 64), load(at + 80)},
          {load(at + 96), load(at + 112), load(at + 128)}};
}

HWY_INLINE Vec3 weighted(V x, const Vec3& a, V y, const Vec3& b, V z, const Vec3& c) {
  return mulAdd(x, a, mulAdd(y, b, z * c));
}
HWY_INLINE Vec3 times(const Vec3& a, const Vec3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

/// What the solid in a cell resists bending and twisting with: derivatives of the first two terms of the energy.
struct SolidPull {
  Vec3 bx, by, bz;  ///< by gradients of strain
  Vec3 strains, shears;
  V coupled;  ///< energy of what moments and the mean strain do to each other
};
/// @param gx, gy, gz  gradients of strain along x, y, z
HWY_INLINE SolidPull solidPull(const CellEdge (&/*e*/)[3], const Moments& /*t*/, const PlaneStress<true>& stress,
                               const Vec3& gx, const Vec3& gy, const Vec3& gz) {
  return {stress(gx), stress(gy), stress(gz), zero3(), zero3(), hn::Zero(Tag())};
}
/// @param strain, shear  of the mean edges: along them, and yz, zx, xy   @param gx, gy, gz  gradients of strain along
/// x, y, z
HWY_INLINE SolidPull solidPullOf(const Vec3& strain, const Vec3& shear, const Moments& t,
                                 const PlaneStress<false>& stress, const Vec3& gx, const Vec3& gy, const Vec3& gz) {
  SolidPull out;
  {
    const Vec3 tx = stress(gx), ty = stress(gy), tz = stress(gz);
    out.strains = {hn::MulAdd(t.first.y, ty.y, hn::Mul(t.first.z, tz.x)),
                   hn::MulAdd(t.first.z, tz.y, hn::Mul(t.first.x, tx.x)),
                   hn::MulAdd(t.first.x, tx.y, hn::Mul(t.first.y, ty.x))};
    out.shears = times(t.first, {tx.z, ty.z, tz.z});
    out.coupled = hn::Add(dot(out.strains, strain), dot(out.shears, shear));
  }
  const V minus = hn::Neg(stress.poisson);
  const Vec3 dx = {hn::Mul(minus, hn::Add(gx.x, gx.y)), gx.x, gx.y};
  const Vec3 dy = {gy.y, hn::Mul(minus, hn::Add(gy.x, gy.y)), gy.x};
  const Vec3 dz = {gz.x, gz.y, hn::Mul(minus, hn::Add(gz.x, gz.y))};
  // Of a component of strain, its integral times p_n: `row` of second moments, `first` moment and mean strain.
  const auto integral = [](V first, V mean, V xn, V along_x, V yn, V along_y, V zn, V along_z) HWY_ATTR {
    return hn::MulAdd(xn, along_x, hn::MulAdd(yn, along_y, hn::MulAdd(zn, along_z, hn::Mul(first, mean))));
  };
  const Vec3 &m = t.mixed, &r = t.square;
  out.bx = stress({integral(t.first.x, strain.y, r.x, dx.y, m.z, dy.y, m.y, dz.y),
                   integral(t.first.x, strain.z, r.x, dx.z, m.z, dy.z, m.y, dz.z),
                   hn::MulAdd(r.x, gx.z, hn::Mul(t.first.x, shear.x))});
  out.by = stress({integral(t.first.y, strain.z, m.z, dx.z, r.y, dy.z, m.x, dz.z),
                   integral(t.first.y, strain.x, m.z, dx.x, r.y, dy.x, m.x, dz.x),
                   hn::MulAdd(r.y, gy.z, hn::Mul(t.first.y, shear.y))});
  out.bz = stress({integral(t.first.z, strain.x, m.y, dx.x, m.x, dy.x, r.z, dz.x),
                   integral(t.first.z, strain.y, m.y, dx.y, m.x, dy.y, r.z, dz.y),
                   hn::MulAdd(r.z, gz.z, hn::Mul(t.first.z, shear.z))});
  return out;
}
HWY_INLINE SolidPull solidPull(const CellEdge (&e)[3], const Moments& t, const PlaneStress<false>& stress,
                               const Vec3& gx, const Vec3& gy, const Vec3& gz) {
  const Vec3 &a = e[0].direction, &b = e[1].direction, &c = e[2].direction;
  // Every term of the shears is small: nothing cancels.
  return solidPullOf({e[0].strain, e[1].strain, e[2].strain}, {dot(b, c), dot(c, a), dot(a, b)}, t, stress, gx, gy, gz);
}

/// cellPull() of moments.glsl. @param rigidity  J, 0 where there is no cell   @param q  replaced by the derivatives
/// by the motion, those by da, db and dc over 4 h [N]   @return energy [J]   @tparam kFull  all cells are full, `t` is
/// not looked at
template <bool kFull>
HWY_INLINE V cellPull(CellMotion& q, const Moments& t, V rigidity, const PlaneStress<kFull>& stress,
                      const CellScale& of) {
  CellEdge e[3];
  const bool fades = cellEdges<!kFull>(q, e);
  const Vec3 &a = e[0].direction, &b = e[1].direction, &c = e[2].direction;
  const Vec3 sa = {dot(a, q.hx), dot(a, q.hy), dot(a, q.hz)}, sb = {dot(b, q.hx), dot(b, q.hy), dot(b, q.hz)};
  const Vec3 sc = {dot(c, q.hx), dot(c, q.hy), dot(c, q.hz)};
  const SolidPull solid = solidPull(e, t, stress, {sb.z, sc.y, hn::Add(sb.y, sc.z)}, {sc.x, sa.z, hn::Add(sc.z, sa.x)},
                                    {sa.y, sb.x, hn::Add(sa.x, sb.y)});
  const V size = hn::Add(dot(sa, sa), hn::Add(dot(sb, sb), dot(sc, sc)));
  const V trace = hn::Add(sa.x, hn::Add(sb.y, sc.z));
  // By s_mn, but for what the springs put into s_mn itself; the energy is quadratic in s.
  const V minus = set(-0.25f), trace4 = hn::Mul(minus, trace);
  const Vec3 pair4 = minus * Vec3{hn::Add(sb.z, sc.y), hn::Add(sc.x, sa.z), hn::Add(sa.y, sb.x)};
  const Vec3 &bx = solid.bx, &by = solid.by, &bz = solid.bz;
  Vec3 ra = {hn::Add(hn::Add(by.z, bz.z), trace4), hn::Add(bz.x, pair4.z), hn::Add(by.y, pair4.y)};
  Vec3 rb = {hn::Add(bz.y, pair4.z), hn::Add(hn::Add(bz.z, bx.z), trace4), hn::Add(bx.x, pair4.x)};
  Vec3 rc = {hn::Add(by.x, pair4.y), hn::Add(bx.y, pair4.x), hn::Add(hn::Add(bx.z, by.z), trace4)};
  V twice = hn::Add(dot(ra, sa), hn::Add(dot(rb, sb), dot(rc, sc)));
  if (!kFull) twice = hn::Add(twice, solid.coupled);
  const V energy = hn::MulAdd(set(0.5f), twice,
                              hn::MulAdd(set(-0.125f), size, hn::Mul(set(0.25f * kAlternating), dot(q.hxyz, q.hxyz))));
  const V bent = hn::Mul(of.bent, size), less = hn::Div(set(1), hn::MulAdd(bent, bent, set(1)));
  const V own = hn::MulAdd(hn::Mul(of.turn, bent), hn::Mul(less, energy), set(-0.25f));
  const V faded = hn::Mul(hn::Mul(rigidity, of.per_4h2), less);
  V scale = faded;
  if (HWY_UNLIKELY(fades)) scale = hn::Mul(faded, hn::Mul(hn::Mul(e[0].fade, e[1].fade), e[2].fade));
  ra = scale * mulAdd(own, sa, ra);
  rb = scale * mulAdd(own, sb, rb);
  rc = scale * mulAdd(own, sc, rc);
  Vec3 ca = weighted(ra.x, q.hx, ra.y, q.hy, ra.z, q.hz), cb = weighted(rb.x, q.hx, rb.y, q.hy, rb.z, q.hz);
  Vec3 cc = weighted(rc.x, q.hx, rc.y, q.hy, rc.z, q.hz);
  if (!kFull) {
    const Vec3 shears = scale * solid.shears;
    ca = mulAdd(shears.y, c, mulAdd(shears.z, b, ca));
    cb = mulAdd(shears.z, a, mulAdd(shears.x, c, cb));
    cc = mulAdd(shears.x, b, mulAdd(shears.y, a, cc));
  }
  q.da = edgePull(e[0], of.per_4h, ca);
  q.db = edgePull(e[1], of.per_4h, cb);
  q.dc = edgePull(e[2], of.per_4h, cc);
  if (!kFull) {
    const Vec3 by_length = hn::Mul(of.per_4h, scale) * solid.strains;
    q.da = mulAdd(hn::Mul(by_length.x, e[0].strain_slope), a, q.da);
    q.db = mulAdd(hn::Mul(by_length.y, e[1].strain_slope), b, q.db);
    q.dc = mulAdd(hn::Mul(by_length.z, e[2].strain_slope), c, q.dc);
  }
  if (HWY_UNLIKELY(fades)) {
    const V lost = hn::Mul(of.per_4h, hn::Mul(faded, energy));
    q.da = mulAdd(hn::Mul(hn::Mul(lost, e[0].fade_slope), hn::Mul(e[1].fade, e[2].fade)), a, q.da);
    q.db = mulAdd(hn::Mul(hn::Mul(lost, e[1].fade_slope), hn::Mul(e[2].fade, e[0].fade)), b, q.db);
    q.dc = mulAdd(hn::Mul(hn::Mul(lost, e[2].fade_slope), hn::Mul(e[0].fade, e[1].fade)), c, q.dc);
  }
  q.hx = weighted(ra.x, a, rb.x, b, rc.x, c);
  q.hy = weighted(ra.y, a, rb.y, b, rc.y, c);
  q.hz = weighted(ra.z, a, rb.z, b, rc.z, c);
  q.hxyz = hn::Mul(scale, set(0.5f * kAlternating)) * q.hxyz;
  return hn::Mul(scale, energy);
}

/// Nodes of a face of cells, summed and differed along x and y.
struct Face {
  Vec3 ss, sd, ds, dd;
};
HWY_INLINE Face faceOf(const Vec3& n00, const Vec3& n10, const Vec3& n01, const Vec3& n11) {
  const Vec3 s0 = n00 + n10, d0 = n10 - n00, s1 = n01 + n11, d1 = n11 - n01;
  return {s0 + s1, s1 - s0, d0 + d1, d1 - d0};
}
/// @param per_4h  1 / (4 h), 0 where there is no cell: nothing is strained there, wherever the nodes around are
HWY_INLINE CellMotion motionBetween(const Face& low, const Face& high, V per_4h) {
  return {per_4h * (low.ds + high.ds),
          per_4h * (low.sd + high.sd),
          per_4h * (high.ss - low.ss),
          high.sd - low.sd,
          high.ds - low.ds,
          low.dd + high.dd,
          high.dd - low.dd};
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
