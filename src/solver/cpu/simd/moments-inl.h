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
#include "solver/cpu/simd/cell_motion-inl.h"
#include "solver/cpu/simd/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kAlternating, layout::kFadeBend, layout::kFadeFull, layout::kFadeNone, layout::kFadeStrain2;

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
  const V one = set(1), phi = mildPhiSoon(growth);
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

/// One by one: arrays of vectors would be kept in memory.
struct CellEdges {
  CellEdge a, b, c;
};

/// @return some edge is so short that the energy fades; else fades are not set
template <bool kStrains>
HWY_INLINE bool cellEdges(const CellMotion& q, CellEdges& e) {
  const V one = set(1), two = set(2);
  const V a = hn::MulAdd(two, q.da.x, dot(q.da, q.da)), b = hn::MulAdd(two, q.db.y, dot(q.db, q.db));
  const V c = hn::MulAdd(two, q.dc.z, dot(q.dc, q.dc));
  const V least = hn::Min(a, hn::Min(b, c)), most = hn::Max(a, hn::Max(b, c));
  if (HWY_LIKELY(hn::AllTrue(Tag(), hn::Lt(hn::Max(most, hn::Neg(least)), set(kMild))))) {
    setMildLength<kStrains>(e.a, a);
    setMildLength<kStrains>(e.b, b);
    setMildLength<kStrains>(e.c, c);
  } else {
    setAnyLength<kStrains>(e.a, a);
    setAnyLength<kStrains>(e.b, b);
    setAnyLength<kStrains>(e.c, c);
  }
  e.a.direction = e.a.shrink * Vec3{hn::Add(q.da.x, one), q.da.y, q.da.z};
  e.b.direction = e.b.shrink * Vec3{q.db.x, hn::Add(q.db.y, one), q.db.z};
  e.c.direction = e.c.shrink * Vec3{q.dc.x, q.dc.y, hn::Add(q.dc.z, one)};
  if (HWY_LIKELY(hn::AllFalse(Tag(), hn::Lt(least, set(kFadeFull * kFadeFull - 1))))) return false;
  setFade(e.a, a);
  setFade(e.b, b);
  setFade(e.c, c);
  return true;
}

/// Of a pull by an edge's direction, and one by its length, its pull by the edge, over 4 h.
HWY_INLINE Vec3 edgePull(const CellEdge& e, V per_4h, const Vec3& by_direction, V by_length) {
  const V share = hn::Mul(per_4h, e.shrink);
  const V along = hn::NegMulAdd(share, dot(e.direction, by_direction), hn::Mul(per_4h, by_length));
  return mulAdd(along, e.direction, share * by_direction);
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
HWY_INLINE SolidPull solidPull(const CellEdges& /*e*/, const Moments& /*t*/, const PlaneStress<true>& stress,
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
HWY_INLINE SolidPull solidPull(const CellEdges& e, const Moments& t, const PlaneStress<false>& stress, const Vec3& gx,
                               const Vec3& gy, const Vec3& gz) {
  const Vec3 &a = e.a.direction, &b = e.b.direction, &c = e.c.direction;
  // Every term of the shears is small: nothing cancels.
  return solidPullOf({e.a.strain, e.b.strain, e.c.strain}, {dot(b, c), dot(c, a), dot(a, b)}, t, stress, gx, gy, gz);
}

/// What thin walls add to a vector of cells (shaders/solver/tissue/bends.glsl): [kBendNumbers] `stride` apart, those
/// with strains times 2 h; null: nothing.
struct ThinWalls {
  const float* numbers = nullptr;
  size_t stride = 0;
};
/// @param cell  index of the vector's first cell in a brick
HWY_INLINE ThinWalls thinWallsOf(const CellJob& job, uint32_t brick, int cell) {
  if (HWY_LIKELY(job.bends == nullptr) || noRows(job.thin_rows[brick], cell)) return {};
  return {job.bends[brick] + cellNumberAt(static_cast<uint32_t>(cell), 0, layout::kBendNumbers), 16};
}

/// 1/x, x > 0: a Newton step on the processor's estimate where that has 12 bits at least; else exact.
HWY_INLINE V inverseOf(V x) {
#if HWY_ARCH_X86
  const V r = hn::ApproximateReciprocal(x);
  return hn::Mul(r, hn::NegMulAdd(x, r, set(2)));
#else
  return hn::Div(set(1), x);
#endif
}

/// s_mn, or what pulls by it: rows are the cell's edges, columns its hourglass motions.
struct Bend {
  Vec3 a, b, c;
};
HWY_INLINE V traceOf(const Bend& s) {
  return hn::Add(s.a.x, hn::Add(s.b.y, s.c.z));
}
HWY_INLINE V squaredTrace(const Bend& s) {
  return hn::MulAdd(s.a.x, s.a.x, hn::MulAdd(s.b.y, s.b.y, hn::Mul(s.c.z, s.c.z)));
}
HWY_INLINE V squaredRest(const Bend& s) {
  const V two = hn::MulAdd(s.a.y, s.a.y, hn::Mul(s.a.z, s.a.z)), four = hn::MulAdd(s.b.x, s.b.x, hn::Mul(s.b.z, s.b.z));
  return hn::Add(hn::MulAdd(s.c.x, s.c.x, two), hn::MulAdd(s.c.y, s.c.y, four));
}

/// Of bent, a number that grows with sum s^2 (1.1 % squared): below it fading changes an energy and its derivatives by
/// less than rounding does, by a share of bent^2 = 6e-8, and is left out.
constexpr float kStraight = 2.5e-4f;

/// How an energy fades: the factor of all its derivatives, and what is due to s_mn for their own.
struct Fading {
  V scale, own;
  V unfaded;  ///< scale without the fading of short edges
};
/// @param size  sum of s^2   @param energy  before it fades
HWY_INLINE Fading fadingOf(const CellEdges& e, bool fades, V size, V energy, V rigidity, const CellScale& of) {
  const V bent = hn::Mul(of.bent, size);
  Fading out;
  if (HWY_LIKELY(!fades && hn::AllTrue(Tag(), hn::Lt(bent, set(kStraight))))) {
    out.own = hn::Zero(Tag());
    out.scale = out.unfaded = hn::Mul(rigidity, of.per_4h2);
    return out;
  }
  const V less = inverseOf(hn::MulAdd(bent, bent, set(1)));
  out.own = hn::Mul(hn::Mul(of.turn, bent), hn::Mul(less, energy));
  out.scale = out.unfaded = hn::Mul(hn::Mul(rigidity, of.per_4h2), less);
  if (HWY_UNLIKELY(fades)) out.scale = hn::Mul(out.scale, hn::Mul(hn::Mul(e.a.fade, e.b.fade), e.c.fade));
  return out;
}

/// bendPull() of bends.glsl. @param r  its derivatives by s are added to it   @param solid  those by strains and
/// shears, and what couples them
HWY_INLINE void addThinWalls(const ThinWalls& walls, const Bend& s, const Vec3& strain, const Vec3& shear, Bend& r,
                             SolidPull& solid) {
  const V of_s[9] = {s.a.x, s.a.y, s.a.z, s.b.x, s.b.y, s.b.z, s.c.x, s.c.y, s.c.z};
  const V of_e[6] = {strain.x, strain.y, strain.z, shear.x, shear.y, shear.z};
  V by_s[9] = {r.a.x, r.a.y, r.a.z, r.b.x, r.b.y, r.b.z, r.c.x, r.c.y, r.c.z};
  const V none = hn::Zero(Tag());
  V by_e[6] = {none, none, none, none, none, none};
  const float* at = walls.numbers;
#pragma GCC unroll 9
  for (int i = 0; i < 9; ++i) {
#pragma GCC unroll 9
    for (int j = i; j < 9; ++j, at += walls.stride) {
      const V m = load(at);
      by_s[i] = hn::MulAdd(m, of_s[j], by_s[i]);
      if (j != i) by_s[j] = hn::MulAdd(m, of_s[i], by_s[j]);
    }
  }
#pragma GCC unroll 9
  for (int i = 0; i < 9; ++i) {
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j, at += walls.stride) {
      const V m = load(at);
      by_s[i] = hn::MulAdd(m, of_e[j], by_s[i]);
      by_e[j] = hn::MulAdd(m, of_s[i], by_e[j]);
    }
  }
  r = {{by_s[0], by_s[1], by_s[2]}, {by_s[3], by_s[4], by_s[5]}, {by_s[6], by_s[7], by_s[8]}};
  const Vec3 strains = {by_e[0], by_e[1], by_e[2]}, shears = {by_e[3], by_e[4], by_e[5]};
  solid.strains = solid.strains + strains;
  solid.shears = solid.shears + shears;
  solid.coupled = hn::Add(solid.coupled, hn::Add(dot(strains, strain), dot(shears, shear)));
}

/// What a cell's moments less its springs do by s_mn, and by the strains of its edges.
struct BendPull {
  Bend by;
  Vec3 strains, shears;
  V energy;  ///< before it fades
  Fading fading;
};
/// @param alternating  energy of hxyz
HWY_INLINE BendPull bendPull(const CellEdges& e, bool fades, const Moments& /*t*/, const ThinWalls& /*walls*/,
                             V rigidity, const PlaneStress<true>& stress, const CellScale& of, const Bend& s,
                             V alternating) {
  // Full cells: a matrix of four numbers.
  const V pair = hn::Sub(stress.aside, set(0.25f)), trace = traceOf(s);
  const V pairs = hn::MulAdd(s.b.z, s.c.y, hn::MulAdd(s.c.x, s.a.z, hn::Mul(s.a.y, s.b.x)));
  const V even = squaredTrace(s), rest = squaredRest(s);
  V energy = hn::MulAdd(set(-1.0f / 12), hn::MulAdd(trace, trace, even), alternating);
  energy = hn::MulAdd(pair, pairs, energy);
  energy = hn::MulAdd(hn::MulAdd(set(0.5f), stress.along, set(-0.25f)), rest, energy);
  const Fading fading = fadingOf(e, fades, hn::Add(even, rest), energy, rigidity, of);
  const V x = hn::Mul(fading.scale, hn::Sub(fading.own, set(1.0f / 6)));
  const V y = hn::Mul(fading.scale, hn::Add(fading.own, hn::Sub(stress.along, set(0.5f))));
  const V z = hn::Mul(fading.scale, pair), all = hn::Mul(hn::Mul(fading.scale, set(-1.0f / 6)), trace);
  const auto other = [&](V own, V across) HWY_ATTR { return hn::MulAdd(y, own, hn::Mul(z, across)); };
  return {{{hn::MulAdd(x, s.a.x, all), other(s.a.y, s.b.x), other(s.a.z, s.c.x)},
           {other(s.b.x, s.a.y), hn::MulAdd(x, s.b.y, all), other(s.b.z, s.c.y)},
           {other(s.c.x, s.a.z), other(s.c.y, s.b.z), hn::MulAdd(x, s.c.z, all)}},
          zero3(),
          zero3(),
          energy,
          fading};
}
HWY_INLINE BendPull bendPull(const CellEdges& e, bool fades, const Moments& t, const ThinWalls& walls, V rigidity,
                             const PlaneStress<false>& stress, const CellScale& of, const Bend& s, V alternating) {
  SolidPull solid = solidPull(e, t, stress, {s.b.z, s.c.y, hn::Add(s.b.y, s.c.z)},
                              {s.c.x, s.a.z, hn::Add(s.c.z, s.a.x)}, {s.a.y, s.b.x, hn::Add(s.a.x, s.b.y)});
  const Vec3 &bx = solid.bx, &by = solid.by, &bz = solid.bz;
  const V quarter = set(0.25f), trace4 = hn::Mul(quarter, traceOf(s));
  Bend r = {
      {hn::Sub(hn::Add(by.z, bz.z), trace4), hn::NegMulAdd(quarter, s.b.x, bz.x), hn::NegMulAdd(quarter, s.c.x, by.y)},
      {hn::NegMulAdd(quarter, s.a.y, bz.y), hn::Sub(hn::Add(bz.z, bx.z), trace4), hn::NegMulAdd(quarter, s.c.y, bx.x)},
      {hn::NegMulAdd(quarter, s.a.z, by.x), hn::NegMulAdd(quarter, s.b.z, bx.y), hn::Sub(hn::Add(bx.z, by.z), trace4)}};
  if (HWY_UNLIKELY(walls.numbers != nullptr)) {
    const Vec3 shear = {dot(e.b.direction, e.c.direction), dot(e.c.direction, e.a.direction),
                        dot(e.a.direction, e.b.direction)};
    addThinWalls(walls, s, {e.a.strain, e.b.strain, e.c.strain}, shear, r, solid);
  }
  const V even = squaredTrace(s), rest = squaredRest(s);
  const V twice = hn::Add(hn::Add(dot(r.a, s.a), dot(r.b, s.b)), hn::Add(dot(r.c, s.c), solid.coupled));
  V energy = hn::MulAdd(set(0.5f), twice, hn::MulAdd(set(-0.125f), even, alternating));
  energy = hn::NegMulAdd(quarter, rest, energy);
  const Fading fading = fadingOf(e, fades, hn::Add(even, rest), energy, rigidity, of);
  const V x = hn::Sub(fading.own, quarter), y = hn::Sub(fading.own, set(0.5f));
  r.a = fading.scale * Vec3{hn::MulAdd(x, s.a.x, r.a.x), hn::MulAdd(y, s.a.y, r.a.y), hn::MulAdd(y, s.a.z, r.a.z)};
  r.b = fading.scale * Vec3{hn::MulAdd(y, s.b.x, r.b.x), hn::MulAdd(x, s.b.y, r.b.y), hn::MulAdd(y, s.b.z, r.b.z)};
  r.c = fading.scale * Vec3{hn::MulAdd(y, s.c.x, r.c.x), hn::MulAdd(y, s.c.y, r.c.y), hn::MulAdd(x, s.c.z, r.c.z)};
  return {r, fading.scale * solid.strains, fading.scale * solid.shears, energy, fading};
}

/// cellPull() of moments.glsl. @param rigidity  J, 0 where there is no cell   @param q  replaced by the derivatives
/// by the motion, those by da, db and dc over 4 h [N]; without addCrushed()   @return energy [J]   @tparam kFull  all
/// cells are full, `t` is not looked at
template <bool kFull>
HWY_INLINE V cellPull(CellMotion& q, const Moments& t, const ThinWalls& walls, V rigidity,
                      const PlaneStress<kFull>& stress, const CellScale& of) {
  CellEdges e;
  const bool fades = cellEdges<!kFull>(q, e);
  const Vec3 &a = e.a.direction, &b = e.b.direction, &c = e.c.direction;
  const Bend s = {{dot(a, q.hx), dot(a, q.hy), dot(a, q.hz)},
                  {dot(b, q.hx), dot(b, q.hy), dot(b, q.hz)},
                  {dot(c, q.hx), dot(c, q.hy), dot(c, q.hz)}};
  const V alternating = hn::Mul(set(0.25f * kAlternating), dot(q.hxyz, q.hxyz));
  const BendPull pull = bendPull(e, fades, t, walls, rigidity, stress, of, s, alternating);
  const Bend& r = pull.by;
  // By the directions of edges, and along these.
  Vec3 by_a = weighted(r.a.x, q.hx, r.a.y, q.hy, r.a.z, q.hz), by_b = weighted(r.b.x, q.hx, r.b.y, q.hy, r.b.z, q.hz);
  Vec3 by_c = weighted(r.c.x, q.hx, r.c.y, q.hy, r.c.z, q.hz);
  V along_a = hn::Zero(Tag()), along_b = along_a, along_c = along_a;
  if constexpr (!kFull) {
    by_a = mulAdd(pull.shears.y, c, mulAdd(pull.shears.z, b, by_a));
    by_b = mulAdd(pull.shears.z, a, mulAdd(pull.shears.x, c, by_b));
    by_c = mulAdd(pull.shears.x, b, mulAdd(pull.shears.y, a, by_c));
    along_a = hn::Mul(pull.strains.x, e.a.strain_slope);
    along_b = hn::Mul(pull.strains.y, e.b.strain_slope);
    along_c = hn::Mul(pull.strains.z, e.c.strain_slope);
  }
  if (HWY_UNLIKELY(fades)) {
    const V lost = hn::Mul(pull.fading.unfaded, pull.energy);
    along_a = hn::MulAdd(hn::Mul(lost, e.a.fade_slope), hn::Mul(e.b.fade, e.c.fade), along_a);
    along_b = hn::MulAdd(hn::Mul(lost, e.b.fade_slope), hn::Mul(e.c.fade, e.a.fade), along_b);
    along_c = hn::MulAdd(hn::Mul(lost, e.c.fade_slope), hn::Mul(e.a.fade, e.b.fade), along_c);
  }
  q.da = edgePull(e.a, of.per_4h, by_a, along_a);
  q.db = edgePull(e.b, of.per_4h, by_b, along_b);
  q.dc = edgePull(e.c, of.per_4h, by_c, along_c);
  q.hx = weighted(r.a.x, a, r.b.x, b, r.c.x, c);
  q.hy = weighted(r.a.y, a, r.b.y, b, r.c.y, c);
  q.hz = weighted(r.a.z, a, r.b.z, b, r.c.z, c);
  q.hxyz = hn::Mul(pull.fading.scale, set(0.5f * kAlternating)) * q.hxyz;
  return hn::Mul(pull.fading.scale, pull.energy);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
