// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Crushed cells, a vector of cells at a time: shaders/solver/tissue/crushed.glsl, whose names these are. Included once
// per instruction set (Highway), by moments-inl.h.
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

using layout::kCrushed, layout::kCrushing, layout::kMostCrushed;

/// No corner is crushed while the sum of these times the squares of the mean edges' growth, of 1 - D |D|, D what their
/// directions span, and of s and hxyz over (2 h)^2 is below 1. Of g^2 = |F^T F - 1|^2 growth is the diagonal and
/// cosines between edges, times lengths, are twice the rest; the sum of their squares is 1.1 (1 - D^2) at most. So mean
/// edges span (1 - g/sqrt(3))^(3/2) at least; at a corner edges differ from them by d^2 <= 1.5 |hx|^2 + ... + 2.25
/// |hxyz|^2, s^2 being 0.65 of that of hx, hy and hz at least, and that takes 1.85 d and d^2 off it. On g^2/0.18 +
/// d^2/0.025 = 1 0.52 is left.
constexpr float kOfGrowth = 1 / 0.18f, kOfShear = 2 * 1.5f * 1.1f / 0.18f;
constexpr float kOfBend = 1.5f / 0.65f / 0.025f, kOfAlternating = 2.25f / 0.025f;

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

/// The four edges along an axis. @param first, second  hourglass motions by the side of each of the other axes
HWY_INLINE void edgesAlong(const Vec3& middle, const Vec3& first, const Vec3& second, const Vec3& both,
                           Vec3 (&out)[4]) {
  const Vec3 even = middle + both, odd = middle - both, sum = first + second, difference = first - second;
  out[0] = even - sum;
  out[1] = odd + difference;
  out[2] = odd - difference;
  out[3] = even + sum;
}

/// @param q  the motion   @param pull  forces as of cellPull(), added to   @return energy [J]
template <class Motion>
HWY_NOINLINE V addCrushed(const Motion& q, V rigidity, V per_4h, Motion& pull) {
  const EdgeTriple mean = meanEdges(q);
  const Vec3 hx = per_4h * q.hx, hy = per_4h * q.hy, hz = per_4h * q.hz, hxyz = per_4h * q.hxyz;
  // Edges along a at (y, z), along b at (z, x), along c at (x, y).
  Vec3 along_a[4], along_b[4], along_c[4];
  edgesAlong(mean.a, hz, hy, hxyz, along_a);
  edgesAlong(mean.b, hx, hz, hxyz, along_b);
  edgesAlong(mean.c, hy, hx, hxyz, along_c);
  const auto at = [&](uint32_t corner) HWY_ATTR {
    const uint32_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    return EdgeTriple{along_a[y + 2 * z], along_b[z + 2 * x], along_c[x + 2 * y]};
  };
  const V none = hn::Zero(Tag()), crushed = set(kCrushed);
  const M there = hn::Gt(rigidity, hn::Zero(Tag()));
  V least = crushed;
  for (uint32_t corner = 0; corner < 8; ++corner) least = hn::Min(least, volumeOf(at(corner)));
  if (hn::AllFalse(Tag(), hn::And(there, hn::Lt(least, crushed)))) return none;
  V energy = none;
  Motion sum = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  for (uint32_t corner = 0; corner < 8; ++corner) {
    const EdgeTriple e = at(corner);
    const V lacks = hn::Max(hn::Sub(crushed, volumeOf(e)), none);
    const V slope = hn::Min(lacks, set(kMostCrushed)), p = hn::Neg(slope);
    energy = hn::MulAdd(slope, hn::NegMulAdd(set(0.5f), slope, lacks), energy);
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
  const V weight = hn::Mul(set(0.125f * kCrushing), rigidity), force = hn::Mul(weight, per_4h);
  pull = {mulAdd(force, sum.da, pull.da),    mulAdd(force, sum.db, pull.db), mulAdd(force, sum.dc, pull.dc),
          mulAdd(force, sum.hx, pull.hx),    mulAdd(force, sum.hy, pull.hy), mulAdd(force, sum.hz, pull.hz),
          mulAdd(force, sum.hxyz, pull.hxyz)};
  return hn::Mul(weight, energy);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
