// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/measure_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/law_measure-inl.h"
#include "solver/cpu/simd/targets.h"
#include "solver/cpu/simd/tiles-inl.h"
#include "viscera/layout/tick_stats.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Returns the lanes with finite components only.
HWY_INLINE M finite(const Vec3& v) {
  const hn::RebindToUnsigned<Tag> bits;
  const auto exponent = hn::Set(bits, 0x7f800000u);
  const auto ofLane = [&](V value) HWY_ATTR { return hn::Ne(hn::And(hn::BitCast(bits, value), exponent), exponent); };
  return hn::RebindMask(Tag(), hn::And(hn::And(ofLane(v.x), ofLane(v.y)), ofLane(v.z)));
}
HWY_INLINE V sumOfLanes(V value) {
  return hn::SumOfLanes(Tag(), value);
}
HWY_INLINE double sum(V value) {
  return static_cast<double>(hn::GetLane(sumOfLanes(value)));
}
HWY_INLINE uint32_t count(M mask) {
  return static_cast<uint32_t>(hn::CountTrue(Tag(), mask));
}

/// Measures the stretch and energy of the springs that a vector's nodes own.
template <int X, int Y, int Z>
HWY_INLINE void measureSpring(const Tile& u, int at, const Material& m, V k, M good, V& stretch, V& elastic,
                              uint32_t& collapsed) {
  constexpr int kKind = X * X + Y * Y + Z * Z - 1;
  const Vec3 far = seen<X, Y, Z>(u, at), w = far - seen<0, 0, 0>(u, at);
  const M there = hn::And(hn::And(good, hn::Gt(k, hn::Zero(Tag()))), finite(far));
  const V q = hn::Mul(dot(w, shifted<X, Y, Z>(w, m.h2)), m.per_length2[kKind]);
  // extension / l0 = sqrt(1 + q) - 1
  const V ratio = hn::Div(q, hn::Add(set(1), hn::Sqrt(hn::Max(hn::Add(set(1), q), hn::Zero(Tag())))));
  const V strain = hn::IfThenElseZero(there, ratio);
  stretch = hn::Max(stretch, hn::Abs(strain));
  elastic = hn::MulAdd(hn::Mul(hn::Div(set(0.5f), m.per_length2[kKind]), k), hn::Mul(strain, strain), elastic);
  collapsed += count(hn::Lt(strain, set(layout::kCollapsed - 1)));
}

using Bits = hn::Vec<hn::RebindToUnsigned<Tag>>;
HWY_INLINE Bits lowBits(const layout::NodeBits* nodes) {
  Bits low, high;
  hn::LoadInterleaved2(hn::RebindToUnsigned<Tag>(), &nodes->lo, low, high);
  return low;
}
/// Returns the nodes with at least one of some bits.
HWY_INLINE M hasBits(Bits of, uint32_t bits) {
  const hn::RebindToUnsigned<Tag> d;
  return hn::RebindMask(Tag(), hn::Ne(hn::And(of, hn::Set(d, bits)), hn::Zero(d)));
}

/// Returns the elastic energy of cells with a law above a vector's nodes [J].
/// @param good  lanes with finite nodes
HWY_INLINE V measureLawCells(const MeasureJob& job, const Material& m, const layout::BodyParams& body, size_t slot,
                             const Vec3 (&corners)[8], M good, BrickStats& stats) {
  const LawMeasured law = measureLaw(job.cells, body, slot, corners);
  V elastic = hn::IfThenElseZero(good, law.energy);
  const V most = set(kMostStiffening), bounded = hn::IfThenElse(hn::Lt(law.stiffening, most), law.stiffening, most);
  const V stiffening = hn::IfThenElseZero(good, bounded);
  stats.max_stiffening = std::max(stats.max_stiffening, hn::GetLane(hn::MaxOfLanes(Tag(), stiffening)));
  const float* broken = job.cells.broken[slot / 64];
  if (HWY_LIKELY(broken == nullptr)) return elastic;
  const float* k = broken + cellNumberAt(static_cast<uint32_t>(slot % 64), 0, kBrokenNumbers);
  return hn::Add(elastic, hn::IfThenElseZero(good, brokenEnergy(k, m, body.origin_spacing.w, corners)));
}

void measureVector(const MeasureJob& job, const Material& m, const Tile& u, uint32_t b, int i, BrickStats& stats) {
  const Arrays& a = job.arrays;
  const size_t slot = size_t{b} * 64 + static_cast<size_t>(i);
  const Bits bits = lowBits(job.nodes + slot);
  const M there = hasBits(bits, 15u << layout::kMassShift);
  if (hn::AllFalse(Tag(), there)) return;
  const int at = ((i >> 4) + 1) * kPlane + kOwn + (i & 15);
  const Vec3 near = seen<0, 0, 0>(u, at), v = loadPlanes(a.velocity + size_t{b} * 192 + static_cast<size_t>(i));
  const M good = hn::And(there, hn::And(finite(near), finite(v)));
  stats.nonfinite += count(there) - count(good);
  V stretch = hn::Zero(Tag()), elastic = stretch;
  const float* k = a.spring_stiffness + springAt(slot, 0);
#define VISCERA_MEASURE(s, X, Y, Z) \
  if ((s) % 2 == 0) measureSpring<X, Y, Z>(u, at, m, load(k + (s)*16), good, stretch, elastic, stats.collapsed);
  VISCERA_SPRINGS(VISCERA_MEASURE)
#undef VISCERA_MEASURE
  Vec3 corners[8];
  cornersAround<0, 0, 0>(corners, u, at);
  const V e = dilationOf(corners, hn::Div(set(0.25f), m.h));
  const M cell = hn::And(good, hasBits(bits, layout::kCellBit));
  const M whole = hn::AndNot(hasBits(bits, layout::kSeveredBit), cell);
  stats.inverted += count(hn::And(whole, hn::Lt(e, set(-1))));
  const layout::BodyParams& body = a.bodies[a.bricks[b].body];
  if (body.law != layout::kLawSprings) elastic = measureLawCells(job, m, body, slot, corners, good, stats);
  const V v2 = hn::IfThenElseZero(good, dot(v, v));
  const V kinetic = hn::Mul(hn::Mul(set(0.5f), load(job.mass + slot)), v2);
  stats.kinetic_j += sum(kinetic);
  stats.elastic_j += sum(elastic);
  stats.max_stretch = std::max(stats.max_stretch, hn::GetLane(hn::MaxOfLanes(Tag(), stretch)));
  stats.max_speed = std::max(stats.max_speed, std::sqrt(hn::GetLane(hn::MaxOfLanes(Tag(), v2))));
}

void measureOf(const MeasureJob& job, const uint32_t* bricks, size_t count) {
  Tile u;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t b = bricks[n];
    const Material m = materialOf(job.arrays.bodies[job.arrays.bricks[b].body]);
    fill<true>(job.arrays, job.arrays.displacement, b, u);
    BrickStats stats{};
    for (int i = 0; i < 64; i += static_cast<int>(hn::MaxLanes(Tag()))) measureVector(job, m, u, b, i, stats);
    job.stats[b] = stats;
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(measureOf);

BrickMeasure measureFor(int64_t target) {
  return VISCERA_KERNEL_FOR(measureOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
