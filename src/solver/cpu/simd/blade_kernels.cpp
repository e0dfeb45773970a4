// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/blade_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/targets.h"
#include "solver/cpu/simd/tiles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Positions of a brick's nodes, relative to the blade's first tip.
struct Positions {
  float first[3];  ///< rest position of the first node [m]
  float h;
  const float* u;
  HWY_INLINE Vec3 at(int i) const { return restOf(first, h, i) + loadPlanes(u + i); }
};

HWY_INLINE Positions positionsOf(const SweepJob& job, uint32_t b) {
  const layout::Brick& brick = job.bricks[b];
  const layout::vec4& origin = job.bodies[brick.body].origin_spacing;
  const float edge = 4 * origin.w;
  return {{origin.x + edge * static_cast<float>(brick.coord_x) - job.from_m[0],
           origin.y + edge * static_cast<float>(brick.coord_y) - job.from_m[1],
           origin.z + edge * static_cast<float>(brick.coord_z) - job.from_m[2]},
          origin.w,
          job.displacement + size_t{b} * 192};
}

HWY_INLINE float leastOf(V v) {
  return hn::GetLane(hn::MinOfLanes(Tag(), v));
}
HWY_INLINE float mostOf(V v) {
  return hn::GetLane(hn::MaxOfLanes(Tag(), v));
}

BrickPositions boundsOf(const SweepJob& job, uint32_t b) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Sweep& sweep = job.sweeps[job.bricks[b].body];
  const Positions positions = positionsOf(job, b);
  const Vec3 center = {set(sweep.center_m[0]), set(sweep.center_m[1]), set(sweep.center_m[2])};
  float size = sweep.radius_m;
  for (int k = 0; k < 3; ++k) size += std::abs(positions.first[k] - sweep.center_m[k]);
  const float radius = sweep.radius_m + kSweepMargin * size;
  const V radius2 = set(radius * radius);
  Vec3 low = {set(kInfinity), set(kInfinity), set(kInfinity)};
  Vec3 high = {set(-kInfinity), set(-kInfinity), set(-kInfinity)};
  V speed2 = hn::Zero(Tag());
  bool near = false, finite = true;
  for (int i = 0; i < 64; i += static_cast<int>(hn::MaxLanes(Tag()))) {
    const Vec3 x = positions.at(i), away = x - center;
    const V away2 = dot(away, away);
    // Positions that are not finite count as near.
    near |= !hn::AllTrue(Tag(), hn::Gt(away2, radius2));
    finite &= hn::AllTrue(Tag(), hn::Lt(away2, set(kInfinity)));
    low = {hn::Min(low.x, x.x), hn::Min(low.y, x.y), hn::Min(low.z, x.z)};
    high = {hn::Max(high.x, x.x), hn::Max(high.y, x.y), hn::Max(high.z, x.z)};
    const Vec3 v = loadPlanes(job.velocity + size_t{b} * 192 + static_cast<size_t>(i));
    const V v2 = dot(v, v);
    speed2 = hn::Max(speed2, hn::IfThenElseZero(hn::Lt(v2, set(kInfinity)), v2));  // not finite: crosses nothing
  }
  BrickPositions out{{leastOf(low.x), leastOf(low.y), leastOf(low.z)},
                     {mostOf(high.x), mostOf(high.y), mostOf(high.z)},
                     mostOf(speed2),
                     near};
  for (int k = 0; k < 3 && !finite; ++k) {
    out.low_m[k] = -kInfinity;
    out.high_m[k] = kInfinity;
  }
  return out;
}

void findPositions(const SweepJob& job, size_t first, size_t last) {
  for (size_t b = first; b < last; ++b) job.positions[b] = boundsOf(job, static_cast<uint32_t>(b));
}

/// Returns 1 << bit in the lanes of a mask.
HWY_INLINE auto bitWhere(M mask, int bit) {
  const hn::RebindToSigned<Tag> ints;
  return hn::IfThenElseZero(hn::RebindMask(ints, mask), hn::Set(ints, 1 << bit));
}

void findSides(const SweepJob& job, const uint32_t* bricks, size_t count) {
  const hn::RebindToSigned<Tag> ints;
  const hn::Rebind<uint8_t, Tag> bytes;
  for (size_t n = 0; n < count; ++n) {
    const Sweep& sweep = job.sweeps[job.bricks[bricks[n]].body];
    const Positions positions = positionsOf(job, bricks[n]);
    for (int i = 0; i < 64; i += static_cast<int>(hn::MaxLanes(Tag()))) {
      const size_t slot = size_t{bricks[n]} * 64 + static_cast<size_t>(i);
      const Vec3 x = positions.at(i);
      const V reach = load(job.reach_m + slot);
      auto sides = hn::Zero(ints);
      for (int k = 0; k < 3; ++k) {
        const float* axis = sweep.axes[k];
        const V along = dot({set(axis[0]), set(axis[1]), set(axis[2])}, x);
        // Positions that are not finite are beyond no side.
        sides = hn::Or(sides, bitWhere(hn::Lt(along, hn::Sub(set(sweep.low_m[k]), reach)), 2 * k));
        sides = hn::Or(sides, bitWhere(hn::Gt(along, hn::Add(set(sweep.high_m[k]), reach)), 2 * k + 1));
      }
      hn::StoreU(hn::DemoteTo(bytes, sides), bytes, job.outside + slot);
    }
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(findPositions);
HWY_EXPORT(findSides);

BrickSweep findPositionsFor(int64_t target) {
  return VISCERA_KERNEL_FOR(findPositions, target);
}
BrickSides findSidesFor(int64_t target) {
  return VISCERA_KERNEL_FOR(findSides, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
