// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/row_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/around-inl.h"
#include "solver/cpu/simd/cells-inl.h"
#include "solver/cpu/simd/targets.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

constexpr int kLanesOfRows = static_cast<int>(hn::MaxLanes(Tag()));

/// Which nodes of a vector are within a row: both springs along an axis are alive. @param slot  of the first
HWY_INLINE M withinRow(const Arrays& a, size_t slot, int axis) {
  const V zero = hn::Zero(Tag());
  const size_t first = static_cast<size_t>(2 * axis);
  return hn::And(hn::Gt(load(a.spring_stiffness + springAt(slot, first)), zero),
                 hn::Gt(load(a.spring_stiffness + springAt(slot, first + 1)), zero));
}

/// Sum of what lies at both sides of a vector's nodes along an axis.
HWY_INLINE Vec3 bothSides(const Surroundings& s, int axis) {
  if (axis == 0) return seen<1, 0, 0>(s) + seen<-1, 0, 0>(s);
  if (axis == 1) return seen<0, 1, 0>(s) + seen<0, -1, 0>(s);
  return seen<0, 0, 1>(s) + seen<0, 0, -1>(s);
}
HWY_INLINE Vec3 secondDifference(const Surroundings& s, int axis) {
  return mulAdd(set(-2), seen<0, 0, 0>(s), bothSides(s, axis));
}

struct RowViews {
  Around u, v;
};

HWY_NOINLINE void differencesOf(const RowJob& job, uint32_t place, RowViews& views) {
  const Arrays& a = job.arrays;
  const uint32_t b = job.rows.brick_of[place];
  const layout::BodyParams& body = a.bodies[a.bricks[b].body];
  const V scale = set(0.25f / body.origin_spacing.w), ahead = set(body.dashpot_s);
  const bool moves = job.dashpot && body.dashpot_s > 0;
  lookAround(a, a.displacement, b, views.u);
  if (moves) lookAround(a, a.velocity, b, views.v);
  for (int i = 0; i < 64; i += kLanesOfRows) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 difference = secondDifference(surroundings(views.u, i), axis);
      if (moves) difference = mulAdd(ahead, secondDifference(surroundings(views.v, i), axis), difference);
      const M within = withinRow(a, size_t{b} * 64 + static_cast<size_t>(i), axis);
      storePlanes(select(within, scale * difference, zero3()),
                  job.rows.values[axis] + size_t{place} * 192 + static_cast<size_t>(i));
    }
  }
}

/// The arrays of places, as lookAround() and sourcesOf() take them.
HWY_INLINE Arrays placesOf(const RowArrays& rows, const float* sums) {
  Arrays out{};
  out.bricks = rows.bricks;
  out.cell_sums = sums;
  return out;
}

/// kSpread: ends are values, and where a node is not within its row what is at both sides. kReturn: values within a row
/// get what ends have at both sides.
HWY_NOINLINE void besideOf(const RowJob& job, uint32_t place, RowViews& views) {
  const bool spreads = job.stage == RowStage::kSpread;
  const uint32_t b = job.rows.brick_of[place];
  for (int axis = 0; axis < 3; ++axis) {
    float* const values = job.rows.values[axis];
    float* const ends = job.rows.ends[axis];
    lookAround(placesOf(job.rows, nullptr), spreads ? values : ends, place, views.u);
    for (int i = 0; i < 64; i += kLanesOfRows) {
      const size_t at = size_t{place} * 192 + static_cast<size_t>(i);
      const M within = withinRow(job.arrays, size_t{b} * 64 + static_cast<size_t>(i), axis);
      const Vec3 beside = bothSides(surroundings(views.u, i), axis), own = loadPlanes(values + at);
      if (spreads)
        storePlanes(select(within, own, beside), ends + at);
      else
        storePlanes(select(within, own + beside, zero3()), values + at);
    }
  }
}

HWY_NOINLINE void gatherOf(const RowJob& job, uint32_t place) {
  const uint32_t b = job.rows.brick_of[place];
  for (int axis = 0; axis < 3; ++axis) {
    const CellSources sources = sourcesOf(placesOf(job.rows, job.rows.sums[axis]), place);
    for (int i = 0; i < 64; i += kLanesOfRows) {
      const size_t at = size_t{place} * 192 + static_cast<size_t>(i);
      const M within = withinRow(job.arrays, size_t{b} * 64 + static_cast<size_t>(i), axis);
      const Vec3 got = forceOfCells(sources, i);
      storePlanes(select(within, got, zero3()), job.rows.values[axis] + at);
      storePlanes(select(within, zero3(), got), job.rows.ends[axis] + at);
    }
  }
}

void rowsOf(const RowJob& job, const uint32_t* places, size_t count) {
  RowViews views;
  for (size_t n = 0; n < count; ++n) {
    if (job.stage == RowStage::kDifferences)
      differencesOf(job, places[n], views);
    else if (job.stage == RowStage::kGather)
      gatherOf(job, places[n]);
    else
      besideOf(job, places[n], views);
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(rowsOf);

BrickRows rowsFor(int64_t target) {
  return VISCERA_KERNEL_FOR(rowsOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
