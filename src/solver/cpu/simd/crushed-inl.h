// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Crushed cells, a vector of cells at a time: shaders/solver/tissue/crushed.glsl, whose names these are. Included once
// per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_CRUSHED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_CRUSHED_INL_H
#undef VISCERA_SOLVER_CPU_CRUSHED_INL_H
#else
#define VISCERA_SOLVER_CPU_CRUSHED_INL_H
#endif

#include "hwy/highway.h"
#include "layout/moments.h"
#include "solver/cpu/simd/cell_motion-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using layout::kCrushed, layout::kCrushing, layout::kMostCrushed, layout::kNearRest2;

struct EdgeTriple {
  Vec3 a, b, c;
};
HWY_INLINE V volumeOf(const EdgeTriple& e) {
  return dot(e.a, cross(e.b, e.c));
}
HWY_INLINE EdgeTriple meanEdges(const CellMotion& q) {
  const V one = set(1);
  return {{hn::Add(one, q.da.x), q.da.y, q.da.z},
          {q.db.x, hn::Add(one, q.db.y), q.db.z},
          {q.dc.x, q.dc.y, hn::Add(one, q.dc.z)}};
}

/// Of squares of hourglass motions, over (2 h)^2: hxyz counts half as much as it does in moments.glsl.
struct Bending {
  V crossed, bent;
};
HWY_INLINE Bending bendingOf(const CellMotion& q, V per_4h2) {
  const V crossed = hn::Mul(hn::Mul(set(0.5f), per_4h2), dot(q.hxyz, q.hxyz));
  const V sum = hn::Add(dot(q.hx, q.hx), hn::Add(dot(q.hy, q.hy), dot(q.hz, q.hz)));
  return {crossed, hn::MulAdd(per_4h2, sum, hn::Add(crossed, crossed))};
}

/// False only where no corner is crushed. @param there  where a cell is: elsewhere its motion may be anything
HWY_INLINE bool mayBeCrushed(const CellMotion& q, M there, V per_4h2) {
  const Bending h = bendingOf(q, per_4h2);
  const V f2 = hn::Add(dot(q.da, q.da), hn::Add(dot(q.db, q.db), dot(q.dc, q.dc)));
  const V d2 = hn::Mul(set(1.5f), hn::Add(h.bent, h.crossed)), left = hn::Sub(hn::Sub(set(kNearRest2), f2), d2);
  const M near = hn::And(hn::Gt(left, hn::Zero(Tag())), hn::Lt(hn::Mul(set(4), hn::Mul(f2, d2)), hn::Mul(left, left)));
  const M far = hn::AndNot(near, there);
  if (HWY_LIKELY(hn::AllFalse(Tag(), far))) return false;
  const EdgeTriple e = meanEdges(q);
  const V change = hn::Sqrt(hn::Mul(set(0.75f), h.bent)), a2 = dot(e.a, e.a), b2 = dot(e.b, e.b), c2 = dot(e.c, e.c);
  const V size2 = hn::Max(a2, hn::Max(b2, c2)), size3 = hn::Mul(set(3), hn::Sqrt(size2));
  const V taken = hn::Mul(change, hn::MulAdd(change, hn::Add(size3, change), hn::Mul(set(3), size2)));
  return !hn::AllTrue(Tag(), hn::Or(hn::Not(far), hn::Ge(hn::Sub(volumeOf(e), taken), set(kCrushed))));
}

/// The four edges along an axis. @param first, second  hourglass motions by the side of each of the other axes
HWY_INLINE void edgesAlong(const Vec3& middle, const Vec3& first, const Vec3& second, const Vec3& both,
                           Vec3 (&out)[4]) {
  const Vec3 even = middle + both, odd = middle - both, sum = first + second, difference = first - second;
  out[0] = even - sum;
  out[1] = odd + difference;
  out[2] = odd - difference;
  out[3] = even + sum;
}

/// Edges at the corners of cells.
struct CornerEdges {
  Vec3 along_a[4], along_b[4], along_c[4];  ///< at (y, z), (z, x), (x, y)
  EdgeTriple at(uint32_t corner) const {
    const uint32_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    return {along_a[y + 2 * z], along_b[z + 2 * x], along_c[x + 2 * y]};
  }
};
HWY_INLINE void setCornerEdges(const CellMotion& q, V per_4h, CornerEdges& out) {
  const EdgeTriple mean = meanEdges(q);
  const Vec3 hx = per_4h * q.hx, hy = per_4h * q.hy, hz = per_4h * q.hz, hxyz = per_4h * q.hxyz;
  edgesAlong(mean.a, hz, hy, hxyz, out.along_a);
  edgesAlong(mean.b, hx, hz, hxyz, out.along_b);
  edgesAlong(mean.c, hy, hx, hxyz, out.along_c);
}

/// What a corner's volume lacks, and the derivative of its energy by it.
struct Crushed {
  V lacks, slope;
  HWY_INLINE V energy() const { return hn::Mul(slope, hn::NegMulAdd(set(0.5f), slope, lacks)); }
};
HWY_INLINE Crushed crushedBy(V volume) {
  const V lacks = hn::Max(hn::Sub(set(kCrushed), volume), hn::Zero(Tag()));
  return {lacks, hn::Min(lacks, set(kMostCrushed))};
}
HWY_INLINE V crushedWeight(V rigidity) {
  return hn::Mul(set(0.125f * kCrushing), rigidity);
}

/// @param q  the motion   @return energy [J]
HWY_INLINE V crushedEnergy(const CellMotion& q, V rigidity, V per_4h) {
  CornerEdges edges;
  setCornerEdges(q, per_4h, edges);
  V energy = hn::Zero(Tag());
  for (uint32_t corner = 0; corner < 8; ++corner)
    energy = hn::Add(energy, crushedBy(volumeOf(edges.at(corner))).energy());
  return hn::Mul(crushedWeight(rigidity), energy);
}

/// @param q  the motion   @param pull  forces as of cellPull(), added to   @return energy [J]
template <class Motion>
HWY_NOINLINE V addCrushed(const Motion& q, V rigidity, V per_4h, Motion& pull) {
  CornerEdges edges;
  setCornerEdges(q, per_4h, edges);
  const V none = hn::Zero(Tag()), crushed = set(kCrushed);
  V least = crushed;
  for (uint32_t corner = 0; corner < 8; ++corner) least = hn::Min(least, volumeOf(edges.at(corner)));
  if (hn::AllFalse(Tag(), hn::And(hn::Gt(rigidity, none), hn::Lt(least, crushed)))) return none;
  V energy = none;
  Motion sum = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  for (uint32_t corner = 0; corner < 8; ++corner) {
    const EdgeTriple e = edges.at(corner);
    const Crushed by = crushedBy(volumeOf(e));
    energy = hn::Add(energy, by.energy());
    const V p = hn::Neg(by.slope);
    const V x = set(corner & 1 ? 1 : -1), y = set(corner & 2 ? 1 : -1), z = set(corner & 4 ? 1 : -1);
    const V yz = hn::Mul(y, z), zx = hn::Mul(z, x), xy = hn::Mul(x, y);
    const Vec3 a = p * cross(e.b, e.c), b = p * cross(e.c, e.a), c = p * cross(e.a, e.b);
    sum.da = sum.da + a;
    sum.db = sum.db + b;
    sum.dc = sum.dc + c;
    sum.hx = mulAdd(z, b, mulAdd(y, c, sum.hx));
    sum.hy = mulAdd(z, a, mulAdd(x, c, sum.hy));
    sum.hz = mulAdd(y, a, mulAdd(x, b, sum.hz));
    sum.hxyz = mulAdd(yz, a, mulAdd(zx, b, mulAdd(xy, c, sum.hxyz)));
  }
  const V weight = crushedWeight(rigidity), force = hn::Mul(weight, per_4h);
  pull = {mulAdd(force, sum.da, pull.da),    mulAdd(force, sum.db, pull.db), mulAdd(force, sum.dc, pull.dc),
          mulAdd(force, sum.hx, pull.hx),    mulAdd(force, sum.hy, pull.hy), mulAdd(force, sum.hz, pull.hz),
          mulAdd(force, sum.hxyz, pull.hxyz)};
  return hn::Mul(weight, energy);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
