// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells by moments, a vector of cells at a time: shaders/solver/moments.glsl, whose names these are. Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_MOMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_MOMENTS_INL_H
#undef VISCERA_SOLVER_CPU_MOMENTS_INL_H
#else
#define VISCERA_SOLVER_CPU_MOMENTS_INL_H
#endif

#include "hwy/highway.h"
#include "layout/moments.h"
#include "solver/cpu/kernels.h"
#include "solver/cpu/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kAlternating, layout::kFadeBend, layout::kFadeFull, layout::kFadeNone, layout::kFadeStrain2;

/// Mean edges less their rest value, and hourglass motions, over h.
struct CellMotion {
  Vec3 da, db, dc, hx, hy, hz, hxyz;
};

/// Plane stress of a material, over mu.
struct PlaneStress {
  V along, aside, poisson;
  Vec3 operator()(const Vec3& v) const {
    return {hn::MulAdd(along, v.x, hn::Mul(aside, v.y)), hn::MulAdd(along, v.y, hn::Mul(aside, v.x)), v.z};
  }
};
/// @param ratio  lambda/mu - 1
HWY_INLINE PlaneStress planeStress(V ratio) {
  const V per = hn::Div(set(1), hn::Add(ratio, set(3)));
  const V poisson = hn::Mul(hn::Add(ratio, set(1)), per);
  return {hn::Mul(set(4), hn::Mul(hn::Add(ratio, set(2)), per)), hn::Add(poisson, poisson), poisson};
}

struct CellEdge {
  Vec3 direction;
  V shrink, strain, strain_slope, fade, fade_slope;
};

/// @param change  of the edge, whose component along itself is `own`   @tparam kStrains  strains are wanted
template <int kAxis, bool kStrains>
HWY_INLINE CellEdge cellEdge(const Vec3& change) {
  const V one = set(1), own = kAxis == 0 ? change.x : kAxis == 1 ? change.y : change.z;
  Vec3 edge = change;
  (kAxis == 0 ? edge.x : kAxis == 1 ? edge.y : edge.z) = hn::Add(own, one);
  const V growth = hn::MulAdd(set(2), own, dot(change, change));
  CellEdge e;
  V size, per_size;
  if (HWY_LIKELY(hn::AllTrue(Tag(), hn::Lt(hn::Abs(growth), set(kMild))))) {
    const V share = hn::Mul(growth, mildPhi(growth));  // (length - 1) / length
    const V stretch = hn::NegMulAdd(growth, share, hn::Sub(growth, share));
    per_size = hn::Sub(one, share);
    size = hn::Add(one, stretch);
    if (kStrains) {  // 1/(1 + x) as a series, to 1e-8
      const V x = hn::Mul(set(1 / kFadeStrain2), hn::Mul(stretch, stretch));
      const V per = hn::NegMulAdd(x, hn::NegMulAdd(x, hn::NegMulAdd(x, hn::Sub(one, x), one), one), one);
      e.strain = hn::Mul(stretch, per);
      e.strain_slope = hn::Mul(hn::Sub(one, x), hn::Mul(per, per));
    }
  } else {
    size = hn::Sqrt(hn::Max(hn::Add(one, growth), set(1e-12f)));
    per_size = hn::Div(one, size);
    if (kStrains) {
      const V stretch = hn::Div(growth, hn::Add(size, one));
      const V q = hn::MulAdd(hn::Mul(stretch, stretch), set(1 / kFadeStrain2), one), per = hn::Div(one, q);
      e.strain = hn::Mul(stretch, per);
      e.strain_slope = hn::Mul(hn::Sub(set(2), q), hn::Mul(per, per));
    }
  }
  if (!kStrains) e.strain = e.strain_slope = hn::Zero(Tag());
  e.direction = per_size * edge;
  e.shrink = per_size;
  e.fade = one;
  e.fade_slope = hn::Zero(Tag());
  const M squeezed = hn::Lt(size, set(kFadeFull));
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), squeezed))) {
    const float kPer = 1 / (kFadeFull - kFadeNone);
    const V t = hn::Min(hn::Max(hn::Mul(hn::Sub(size, set(kFadeNone)), set(kPer)), hn::Zero(Tag())), one);
    e.fade = hn::Mul(hn::Mul(t, t), hn::NegMulAdd(set(2), t, set(3)));
    e.fade_slope = hn::Mul(set(6 * kPer), hn::Mul(t, hn::Sub(one, t)));
  }
  return e;
}

HWY_INLINE Vec3 edgePull(const CellEdge& e, const Vec3& by_direction, V by_length) {
  const Vec3 across = mulAdd(hn::Neg(dot(e.direction, by_direction)), e.direction, by_direction);
  return mulAdd(by_length, e.direction, e.shrink * across);
}

/// Moments of cells over their shares; those of full ones are constants.
struct Moments {
  Vec3 first, square, mixed;
};
/// @param planes  of their brick, at the first cell of the vector
HWY_INLINE Moments loadMoments(const float* planes) {
  return {loadPlanes(planes), loadPlanes(planes + 192), loadPlanes(planes + 384)};
}

HWY_INLINE Vec3 weighted(V x, const Vec3& a, V y, const Vec3& b, V z, const Vec3& c) {
  return mulAdd(x, a, mulAdd(y, b, z * c));
}
HWY_INLINE Vec3 times(const Vec3& a, const Vec3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

/// cellPull() of moments.glsl. @param rigidity  J, 0 where there is no cell   @param q  replaced by the derivatives by
/// it   @return energy [J]   @tparam kFull  all are filled all through, `t` is not looked at
template <bool kFull>
HWY_INLINE V cellPull(CellMotion& q, const Moments& t, V rigidity, const PlaneStress& stress) {
  const CellEdge ea = cellEdge<0, !kFull>(q.da), eb = cellEdge<1, !kFull>(q.db), ec = cellEdge<2, !kFull>(q.dc);
  const Vec3 sa = {dot(ea.direction, q.hx), dot(ea.direction, q.hy), dot(ea.direction, q.hz)};
  const Vec3 sb = {dot(eb.direction, q.hx), dot(eb.direction, q.hy), dot(eb.direction, q.hz)};
  const Vec3 sc = {dot(ec.direction, q.hx), dot(ec.direction, q.hy), dot(ec.direction, q.hz)};
  const Vec3 gx = {sb.z, sc.y, hn::Add(sb.y, sc.z)}, gy = {sc.x, sa.z, hn::Add(sc.z, sa.x)};
  const Vec3 gz = {sa.y, sb.x, hn::Add(sa.x, sb.y)};
  const Vec3 tx = stress(gx), ty = stress(gy), tz = stress(gz);
  Vec3 bx, by, bz, shears;
  V solid, strain_a = hn::Zero(Tag()), strain_b = strain_a, strain_c = strain_a;
  if (kFull) {
    const V twelfth = set(1.0f / 12);
    bx = twelfth * tx;
    by = twelfth * ty;
    bz = twelfth * tz;
    solid = hn::Mul(set(0.5f), hn::Add(dot(bx, gx), hn::Add(dot(by, gy), dot(bz, gz))));
    shears = zero3();
  } else {
    const V minus = hn::Neg(stress.poisson);
    const Vec3 dx = {hn::Mul(minus, hn::Add(gx.x, gx.y)), gx.x, gx.y};
    const Vec3 dy = {gy.y, hn::Mul(minus, hn::Add(gy.x, gy.y)), gy.x};
    const Vec3 dz = {gz.x, gz.y, hn::Mul(minus, hn::Add(gz.x, gz.y))};
    const V yz = hn::Mul(hn::Add(hn::Add(q.dc.y, q.db.z), dot(q.db, q.dc)), hn::Mul(eb.shrink, ec.shrink));
    const V zx = hn::Mul(hn::Add(hn::Add(q.da.z, q.dc.x), dot(q.dc, q.da)), hn::Mul(ec.shrink, ea.shrink));
    const V xy = hn::Mul(hn::Add(hn::Add(q.db.x, q.da.y), dot(q.da, q.db)), hn::Mul(ea.shrink, eb.shrink));
    const Vec3 mx = weighted(t.square.x, dx, t.mixed.z, dy, t.mixed.y, dz);
    const Vec3 my = weighted(t.mixed.z, dx, t.square.y, dy, t.mixed.x, dz);
    const Vec3 mz = weighted(t.mixed.y, dx, t.mixed.x, dy, t.square.z, dz);
    const Vec3 ix = {mx.y, mx.z, hn::Mul(t.square.x, gx.z)}, iy = {my.z, my.x, hn::Mul(t.square.y, gy.z)};
    const Vec3 iz = {mz.x, mz.y, hn::Mul(t.square.z, gz.z)};
    const Vec3 wx = t.first.x * Vec3{eb.strain, ec.strain, yz}, wy = t.first.y * Vec3{ec.strain, ea.strain, zx};
    const Vec3 wz = t.first.z * Vec3{ea.strain, eb.strain, xy};
    const V half = set(0.5f);
    solid =
        hn::Add(dot(tx, mulAdd(half, ix, wx)), hn::Add(dot(ty, mulAdd(half, iy, wy)), dot(tz, mulAdd(half, iz, wz))));
    bx = stress(wx + ix);
    by = stress(wy + iy);
    bz = stress(wz + iz);
    strain_a = hn::MulAdd(t.first.y, ty.y, hn::Mul(t.first.z, tz.x));
    strain_b = hn::MulAdd(t.first.z, tz.y, hn::Mul(t.first.x, tx.x));
    strain_c = hn::MulAdd(t.first.x, tx.y, hn::Mul(t.first.y, ty.x));
    shears = times(t.first, {tx.z, ty.z, tz.z});
  }
  const V size = hn::Add(dot(sa, sa), hn::Add(dot(sb, sb), dot(sc, sc)));
  const V trace = hn::Add(sa.x, hn::Add(sb.y, sc.z));
  const Vec3 pair = {hn::Add(sb.z, sc.y), hn::Add(sc.x, sa.z), hn::Add(sa.y, sb.x)};
  const V springs = hn::Add(size, hn::MulAdd(trace, trace, dot(pair, pair)));
  const V energy = hn::MulAdd(set(-0.125f), springs, hn::MulAdd(set(0.5f * kAlternating), dot(q.hxyz, q.hxyz), solid));
  const V quarter = set(-0.25f);
  Vec3 ra = mulAdd(quarter, sa + Vec3{trace, pair.z, pair.y}, {hn::Add(by.z, bz.z), bz.x, by.y});
  Vec3 rb = mulAdd(quarter, sb + Vec3{pair.z, trace, pair.x}, {bz.y, hn::Add(bz.z, bx.z), bx.x});
  Vec3 rc = mulAdd(quarter, sc + Vec3{pair.y, pair.x, trace}, {by.x, bx.y, hn::Add(bx.z, by.z)});
  const V bent = hn::Mul(size, set(1 / kFadeBend)), less = hn::Div(set(1), hn::MulAdd(bent, bent, set(1)));
  const V turn = hn::Mul(hn::Mul(set(-4 / kFadeBend), bent), hn::Mul(less, energy));
  ra = mulAdd(turn, sa, ra);
  rb = mulAdd(turn, sb, rb);
  rc = mulAdd(turn, sc, rc);
  const V faded = hn::Mul(rigidity, less), fade_ab = hn::Mul(ea.fade, eb.fade);
  const V scale = hn::Mul(faded, hn::Mul(fade_ab, ec.fade)), lost = hn::Mul(faded, energy);
  Vec3 ca = weighted(ra.x, q.hx, ra.y, q.hy, ra.z, q.hz), cb = weighted(rb.x, q.hx, rb.y, q.hy, rb.z, q.hz);
  Vec3 cc = weighted(rc.x, q.hx, rc.y, q.hy, rc.z, q.hz);
  if (!kFull) {
    ca = mulAdd(shears.y, ec.direction, mulAdd(shears.z, eb.direction, ca));
    cb = mulAdd(shears.z, ea.direction, mulAdd(shears.x, ec.direction, cb));
    cc = mulAdd(shears.x, eb.direction, mulAdd(shears.y, ea.direction, cc));
  }
  const auto by_length = [&](const CellEdge& e, V strain, V other_fades) HWY_ATTR {
    const V of_fade = hn::Mul(hn::Mul(lost, other_fades), e.fade_slope);
    return kFull ? of_fade : hn::MulAdd(hn::Mul(scale, strain), e.strain_slope, of_fade);
  };
  q.da = edgePull(ea, scale * ca, by_length(ea, strain_a, hn::Mul(eb.fade, ec.fade)));
  q.db = edgePull(eb, scale * cb, by_length(eb, strain_b, hn::Mul(ec.fade, ea.fade)));
  q.dc = edgePull(ec, scale * cc, by_length(ec, strain_c, fade_ab));
  q.hx = scale * weighted(ra.x, ea.direction, rb.x, eb.direction, rc.x, ec.direction);
  q.hy = scale * weighted(ra.y, ea.direction, rb.y, eb.direction, rc.y, ec.direction);
  q.hz = scale * weighted(ra.z, ea.direction, rb.z, eb.direction, rc.z, ec.direction);
  q.hxyz = hn::Mul(scale, set(kAlternating)) * q.hxyz;
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
/// @param per_h  1/h
HWY_INLINE CellMotion motionBetween(const Face& low, const Face& high, V per_h) {
  const V quarter = hn::Mul(set(0.25f), per_h), half = hn::Mul(set(0.5f), per_h);
  return {quarter * (low.ds + high.ds),
          quarter * (low.sd + high.sd),
          quarter * (high.ss - low.ss),
          half * (high.sd - low.sd),
          half * (high.ds - low.ds),
          half * (low.dd + high.dd),
          hn::Mul(set(0.35355339f), per_h) * (high.dd - low.dd)};
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
