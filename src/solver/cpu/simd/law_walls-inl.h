// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells in thin walls, a vector at a time: the law with second derivatives from rows of nodes (physics.md 1, Thin
// walls; shaders/solver/tissue/law_walls.glsl). Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAW_WALLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAW_WALLS_INL_H
#undef VISCERA_SOLVER_CPU_LAW_WALLS_INL_H
#else
#define VISCERA_SOLVER_CPU_LAW_WALLS_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kRowStressAcross;

/// Second derivatives from rows of nodes, or derivatives by them: half of the second derivative along each axis, and
/// its variation along the next two axes, in cyclic order.
struct RowMotion {
  Vec3 second[3], varies[3][2];
};

struct LawWall {
  Vec3 normal, rows;
  V across, variation;
};
/// Loads the walls of a vector of cells.
/// @param numbers  of the first cell (WallGroups::numbers); the next number is 16 farther
HWY_INLINE LawWall loadWall(const float* numbers) {
  return {{load(numbers), load(numbers + 16), load(numbers + 32)},
          {load(numbers + 48), load(numbers + 64), load(numbers + 80)},
          load(numbers + 96),
          load(numbers + 112)};
}

/// Adds the motion of the rows along an axis.
/// @param edges  sums of the second differences at both ends of each edge along the axis, over 4 h; by side along the
/// next axis, then along the one after it
HWY_INLINE void addRowMotion(const Vec3 (&edges)[2][2], int axis, RowMotion& out) {
  const Vec3 low = edges[0][0] + edges[0][1], high = edges[1][0] + edges[1][1];
  out.second[axis] = set(0.25f) * (low + high);
  out.varies[axis][0] = high - low;
  out.varies[axis][1] = (edges[0][1] + edges[1][1]) - (edges[0][0] + edges[1][0]);
}

/// A symmetric tensor: xx, yy, zz; and yz, zx, xy, doubled for strains.
struct Symmetric {
  Vec3 pulled, sheared;
};
HWY_INLINE Symmetric weighed(const Symmetric (&g)[3], V x, V y, V z) {
  return {mulAdd(x, g[0].pulled, mulAdd(y, g[1].pulled, z * g[2].pulled)),
          mulAdd(x, g[0].sheared, mulAdd(y, g[1].sheared, z * g[2].sheared))};
}

/// Excess of the second derivatives from rows over those of the cell itself: v of physics.md 1, by axis.
struct RowExcess {
  Vec3 x, y, z;
};
/// Returns this excess.
/// @param s, e  of hourglass motions and of rows, in the frame
HWY_INLINE RowExcess excessOf(V poisson, const Vec3& rows, const Curvatures& s, const Curvatures& e) {
  const auto own = [&](V a, V b) HWY_ATTR { return hn::Mul(poisson, hn::Add(a, b)); };
  const Vec3 x = {own(s.z.y, s.y.z), s.z.x, s.y.x}, y = {s.z.y, own(s.x.z, s.z.x), s.x.y};
  const Vec3 z = {s.y.z, s.x.z, own(s.y.x, s.x.y)};
  return {rows.x * (e.x + x), rows.y * (e.y + y), rows.z * (e.z + z)};
}
/// Adds to the derivatives by s those through the excess.
/// @param r  derivatives by the excess times the share of rows
HWY_INLINE void addExcess(V poisson, const RowExcess& r, Curvatures& k) {
  const auto add = [](V& to, V a, V b) HWY_ATTR { to = hn::Add(to, hn::Add(a, b)); };
  const V px = hn::Mul(poisson, r.x.x), py = hn::Mul(poisson, r.y.y), pz = hn::Mul(poisson, r.z.z);
  add(k.z.y, px, r.y.x);
  add(k.y.z, px, r.z.x);
  add(k.z.x, py, r.x.y);
  add(k.x.z, py, r.z.y);
  add(k.y.x, pz, r.x.z);
  add(k.x.y, pz, r.y.z);
}

/// Computes twice the gradient of strain along each axis.
HWY_INLINE void gradientsOf(V poisson, const Curvatures& s, const RowExcess& v, Symmetric (&g)[3]) {
  const auto thin = [&](V a, V b, V more) HWY_ATTR { return hn::NegMulAdd(poisson, hn::Add(a, b), more); };
  g[0] = {{thin(s.z.y, s.y.z, v.x.x), s.z.y, s.y.z}, {hn::Add(s.y.y, s.z.z), v.x.z, v.x.y}};
  g[1] = {{s.z.x, thin(s.x.z, s.z.x, v.y.y), s.x.z}, {v.y.z, hn::Add(s.z.z, s.x.x), v.y.x}};
  g[2] = {{s.y.x, s.x.y, thin(s.y.x, s.x.y, v.z.z)}, {v.z.y, v.z.x, hn::Add(s.x.x, s.y.y)}};
}

/// Computes the derivatives of s.K.s/2 by the gradients of strain over mu: the moments of stresses. All but a tenth of
/// the stress across the wall is relieved.
HWY_INLINE void momentsOf(const LawBody& body, const LawMoments& m, const LawWall& wall, const Symmetric (&g)[3],
                          Symmetric (&out)[3]) {
  const V lambda = hn::Sub(body.bulk, set(2.0f / 3)), two = set(2);
  const V relieved = hn::Div(hn::Mul(set(1 - kRowStressAcross), wall.across), hn::Add(lambda, two));
  const Vec3& n = wall.normal;
  const Vec3 square = {hn::Mul(n.x, n.x), hn::Mul(n.y, n.y), hn::Mul(n.z, n.z)};
  const Vec3 mixed = {hn::Mul(n.y, n.z), hn::Mul(n.z, n.x), hn::Mul(n.x, n.y)};
  const Vec3 of_pulled = {hn::MulAdd(two, square.x, lambda), hn::MulAdd(two, square.y, lambda),
                          hn::MulAdd(two, square.z, lambda)};
  const Symmetric b[3] = {weighed(g, m.square.x, m.mixed.z, m.mixed.y), weighed(g, m.mixed.z, m.square.y, m.mixed.x),
                          weighed(g, m.mixed.y, m.mixed.x, m.square.z)};
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = b[k].pulled, &t = b[k].sheared;
    const V pressure = hn::Mul(lambda, hn::Add(p.x, hn::Add(p.y, p.z)));
    const V across = hn::Mul(relieved, hn::MulAdd(two, dot(mixed, t), dot(of_pulled, p)));
    const auto pulled = [&](V own, V of) HWY_ATTR { return hn::NegMulAdd(across, of, hn::MulAdd(two, own, pressure)); };
    out[k] = {{pulled(p.x, of_pulled.x), pulled(p.y, of_pulled.y), pulled(p.z, of_pulled.z)},
              mulAdd(hn::Neg(hn::Mul(two, across)), mixed, t)};
  }
}

/// Weights of the variation along axis `l` of the second derivatives along axis `k`: its contributions to columns l and
/// k of the gradient.
struct RowWeights {
  V at_l, at_k;
};
HWY_INLINE RowWeights rowWeights(const LawMoments& m, const LawWall& wall, int k, int l) {
  const V ck = component(m.centroid2, k), cl = component(m.centroid2, l), quarter = hn::Mul(set(0.25f), wall.variation);
  const V square = hn::MulAdd(ck, ck, hn::Sub(component(m.square, k), set(1)));  // 4 (M_kk - 1/4)
  const V mixed = hn::MulAdd(ck, cl, component(m.mixed, 3 - k - l));
  return {hn::Mul(hn::Mul(set(0.5f), quarter), square), hn::Mul(quarter, mixed)};
}

/// F* of a cell in a thin wall, and its inputs.
struct WallPoint {
  Columns c, g, star;
  V e, inverse;
  Curvatures s, rows;  ///< hourglass motions and rows, in the frame
  RowExcess v;
};
/// Computes F* and its inputs.
/// @param kAny  as for lawForcesOf()
template <bool kAny>
HWY_INLINE WallPoint wallPoint(const LawBody& body, const LawMoments& m, const LawWall& wall, M there,
                               const CellModes& q, const RowMotion& rows) {
  WallPoint out;
  const Columns d = {q.da, q.db, q.dc};
  out.c = cofactorsOf(d);
  out.e = hn::IfThenElseZero(there, dilationOf(d, out.c));
  const V j = hn::Add(out.e, set(1));
  out.inverse = hn::Div(set(1), kAny ? hn::Max(j, set(kLeastVolume)) : j);
  const auto inFrame = [&](const Vec3& h) HWY_ATTR { return out.inverse * transposedOf(out.c, h); };
  out.s = {inFrame(q.hx), inFrame(q.hy), inFrame(q.hz)};
  out.rows = {inFrame(rows.second[0]), inFrame(rows.second[1]), inFrame(rows.second[2])};
  out.v = excessOf(body.poisson, wall.rows, out.s, out.rows);
  out.g = atCentroid(body.poisson, out.s, m.centroid2);
  out.g = {mulAdd(m.centroid2.x, out.v.x, out.g.a), mulAdd(m.centroid2.y, out.v.y, out.g.b),
           mulAdd(m.centroid2.z, out.v.z, out.g.c)};
  Vec3 star[3] = {timesOf(d, out.g.a) + d.a, timesOf(d, out.g.b) + d.b, timesOf(d, out.g.c) + d.c};
  for (int k = 0; k < 3; ++k) {
    for (int other = 0; other < 2; ++other) {
      const int l = (k + 1 + other) % 3;
      const RowWeights w = rowWeights(m, wall, k, l);
      star[l] = mulAdd(w.at_l, rows.varies[k][other], star[l]);
      star[k] = mulAdd(w.at_k, rows.varies[k][other], star[k]);
    }
  }
  out.star = {star[0], star[1], star[2]};
  return out;
}

/// Adds to the derivatives by the mean gradient the terms of addCofactorPull() for the cell itself and for rows.
/// @param r, rd  derivatives by s and by rows
HWY_INLINE Columns addWallPull(const Columns& p, V inverse, const Curvatures& r, const Curvatures& rd,
                               const CellModes& q, const RowMotion& rows) {
  const Columns flat = addCofactorPull(p, inverse, r, q), none = {zero3(), zero3(), zero3()};
  CellModes of_rows = q;
  of_rows.hx = rows.second[0];
  of_rows.hy = rows.second[1];
  of_rows.hz = rows.second[2];
  const Columns more = addCofactorPull(none, inverse, rd, of_rows);
  return {flat.a + more.a, flat.b + more.b, flat.c + more.c};
}

/// Adds the derivatives by the variation of the second derivatives from rows.
/// @param ps  dW/dF at F*
HWY_INLINE void pullVariation(const LawMoments& m, const LawWall& wall, const Columns& ps, RowMotion& pull) {
  const Vec3 p[3] = {ps.a, ps.b, ps.c};
  for (int k = 0; k < 3; ++k) {
    for (int other = 0; other < 2; ++other) {
      const int l = (k + 1 + other) % 3;
      const RowWeights w = rowWeights(m, wall, k, l);
      pull.varies[k][other] = mulAdd(w.at_l, p[l], w.at_k * p[k]);
    }
  }
}

/// Computes lawForcesOf() for cells in thin walls.
/// @param pull  derivatives by the motion of rows [N]
template <bool kAny>
HWY_INLINE bool wallForcesOf(const LawBody& body, const LawMoments& m, const LawWall& wall, const float* laminate, V mu,
                             const CellModes& q, const RowMotion& rows, CellModes& out, RowMotion& pull) {
  const V least = set(kLeastVolume - 1);
  const M there = hn::Gt(mu, hn::Zero(Tag()));
  const WallPoint at = wallPoint<kAny>(body, m, wall, there, q, rows);
  const Columns d = {q.da, q.db, q.dc}, of_star = cofactorsOf(at.star);
  const V e_star = hn::IfThenElseZero(there, dilationOf(at.star, of_star));
  if (!kAny && HWY_UNLIKELY(!hn::AllTrue(Tag(), hn::Ge(hn::Min(at.e, e_star), least)))) return false;
  const Columns ps = HWY_UNLIKELY(laminate != nullptr)
                         ? laminateStress(body, laminate, mu, at.star, of_star, e_star)
                         : lawStress<kAny>(body, mu, at.star, of_star, e_star, volumeOf<kAny>(e_star));
  Symmetric g[3], sigma[3];
  gradientsOf(body.poisson, at.s, at.v, g);
  momentsOf(body, m, wall, g, sigma);
  const auto thin = [&](V of, V own) HWY_ATTR { return hn::Mul(mu, hn::NegMulAdd(body.poisson, own, of)); };
  const Symmetric &x = sigma[0], &y = sigma[1], &z = sigma[2];
  const V bx = hn::Mul(mu, x.sheared.x), by = hn::Mul(mu, y.sheared.y), bz = hn::Mul(mu, z.sheared.z);
  Curvatures r = {{hn::Add(by, bz), thin(z.pulled.y, z.pulled.z), thin(y.pulled.z, y.pulled.y)},
                  {thin(z.pulled.x, z.pulled.z), hn::Add(bz, bx), thin(x.pulled.z, x.pulled.x)},
                  {thin(y.pulled.x, y.pulled.y), thin(x.pulled.y, x.pulled.x), hn::Add(bx, by)}};
  const Columns of_g = {transposedOf(d, ps.a), transposedOf(d, ps.b), transposedOf(d, ps.c)};
  addAtCentroid(body.poisson, of_g, m.centroid2, r);
  const auto excess = [&](const Vec3& moment, V c2, const Vec3& of, V share)
                          HWY_ATTR { return share * mulAdd(mu, moment, c2 * of); };
  const RowExcess rd = {excess({x.pulled.x, x.sheared.z, x.sheared.y}, m.centroid2.x, of_g.a, wall.rows.x),
                        excess({y.sheared.z, y.pulled.y, y.sheared.x}, m.centroid2.y, of_g.b, wall.rows.y),
                        excess({z.sheared.y, z.sheared.x, z.pulled.z}, m.centroid2.z, of_g.c, wall.rows.z)};
  addExcess(body.poisson, rd, r);
  const auto back = [&](const Vec3& of) HWY_ATTR { return timesOf(at.c, at.inverse * of); };
  out.hxyz = hn::Mul(set(2 * kLawAlternating), mu) * q.hxyz;
  out.hx = back(r.x);
  out.hy = back(r.y);
  out.hz = back(r.z);
  pull.second[0] = back(rd.x);
  pull.second[1] = back(rd.y);
  pull.second[2] = back(rd.z);
  pullVariation(m, wall, ps, pull);
  const auto byColumn = [&](const Vec3& p, const Vec3& by_g, V hx, V hy, V hz, V dx, V dy, V dz) HWY_ATTR {
    const Vec3 whole = plusThree(p, ps.a, by_g.x, ps.b, by_g.y, ps.c, by_g.z);
    const Vec3 less = minusThree(whole, out.hx, hx, out.hy, hy, out.hz, hz);
    return minusThree(less, pull.second[0], dx, pull.second[1], dy, pull.second[2], dz);
  };
  const Curvatures &s = at.s, &w = at.rows;
  const Vec3 ga = {at.g.a.x, at.g.b.x, at.g.c.x}, gb = {at.g.a.y, at.g.b.y, at.g.c.y};
  const Vec3 gc = {at.g.a.z, at.g.b.z, at.g.c.z};
  out.da = byColumn(ps.a, ga, s.x.x, s.y.x, s.z.x, w.x.x, w.y.x, w.z.x);
  out.db = byColumn(ps.b, gb, s.x.y, s.y.y, s.z.y, w.x.y, w.y.y, w.z.y);
  out.dc = byColumn(ps.c, gc, s.x.z, s.y.z, s.z.z, w.x.z, w.y.z, w.z.z);
  if constexpr (kAny) {
    const M below = hn::Lt(at.e, least);
    const Columns p = {plusThree(ps.a, ps.a, ga.x, ps.b, ga.y, ps.c, ga.z),
                       plusThree(ps.b, ps.a, gb.x, ps.b, gb.y, ps.c, gb.z),
                       plusThree(ps.c, ps.a, gc.x, ps.b, gc.y, ps.c, gc.z)};
    const Columns flat = addWallPull(p, at.inverse, r, {rd.x, rd.y, rd.z}, q, rows);
    out.da = select(below, flat.a, out.da);
    out.db = select(below, flat.b, out.db);
    out.dc = select(below, flat.c, out.dc);
  }
  return true;
}
inline HWY_NOINLINE void squeezedWallForces(const LawBody& body, const LawMoments& m, const LawWall& wall,
                                            const float* laminate, V mu, const CellModes& q, const RowMotion& rows,
                                            CellModes& out, RowMotion& pull) {
  wallForcesOf<true>(body, m, wall, laminate, mu, q, rows, out, pull);
}
inline HWY_NOINLINE void wallForces(const LawBody& body, const LawMoments& m, const LawWall& wall,
                                    const float* laminate, V mu, const CellModes& q, const RowMotion& rows,
                                    CellModes& out, RowMotion& pull) {
  if (HWY_UNLIKELY((!wallForcesOf<false>(body, m, wall, laminate, mu, q, rows, out, pull))))
    squeezedWallForces(body, m, wall, laminate, mu, q, rows, out, pull);
}

/// Returns the contribution of the cell to an edge along an axis, at sides -1 or 1 along the next axis and the one
/// after it.
HWY_INLINE Vec3 pullOfEdge(const RowMotion& pull, int axis, int side, int other) {
  const Vec3 mean = set(-0.25f) * pull.second[axis];
  return mulAdd(set(static_cast<float>(-side)), pull.varies[axis][0],
                mulAdd(set(static_cast<float>(-other)), pull.varies[axis][1], mean));
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
