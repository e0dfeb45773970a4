// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/cell_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/moments-inl.h"
#include "solver/cpu/targets.h"
#include "solver/cpu/tiles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Displacements of a brick's nodes and of those above it, rows as they are and shifted by 1 along x: the node at
/// (x, y, z) + (dx, 0, 0), with x in 0..3 and y, z in 0..4, is at[dx][z * kUpPlane + 4 * y + x].
constexpr int kUpPlane = 32;
struct alignas(64) UpTile {
  float component[3][2][5 * kUpPlane];
};

/// Rows of a plane, as they are and shifted by 1. @param right  those of the brick at the right
template <class D>
HWY_INLINE void copyUp(D d, const float* own, const float* right, float* zero, float* plus) {
  const auto middle = hn::LoadU(d, own);
  hn::StoreU(middle, d, zero);
  hn::StoreU(hn::CombineShiftRightBytes<4>(d, hn::LoadU(d, right), middle), d, plus);
}

HWY_INLINE void fillUp(const Arrays& a, uint32_t b, UpTile& tile) {
  const Tag d;
  const Row row;
  const uint32_t* around = a.bricks[b].neighbors;
  const auto brick = [&](int direction) HWY_ATTR { return a.displacement + size_t{around[direction]} * 192; };
  for (int z = 0; z <= 4; ++z) {
    const int layer = 13 + 9 * (z >> 2);
    const float *own = brick(layer), *right = brick(layer + 1), *behind = brick(layer + 3), *corner = brick(layer + 4);
    for (int c = 0; c < 3; ++c) {
      const int from = 64 * c + (z & 3) * 16, to = z * kUpPlane;
      float *zero = tile.component[c][0] + to, *plus = tile.component[c][1] + to;
      for (int i = 0; i < 16; i += static_cast<int>(hn::MaxLanes(d))) {
        copyUp(d, own + from + i, right + from + i, zero + i, plus + i);
      }
      copyUp(row, behind + from, corner + from, zero + 16, plus + 16);
    }
  }
}

template <int kX>
HWY_INLINE Vec3 upAt(const UpTile& tile, int at) {
  return {load(tile.component[0][kX] + at), load(tile.component[1][kX] + at), load(tile.component[2][kX] + at)};
}
HWY_INLINE Face faceAt(const UpTile& tile, int at) {
  return faceOf(upAt<0>(tile, at), upAt<1>(tile, at), upAt<0>(tile, at + 4), upAt<1>(tile, at + 4));
}

/// What four corners at one height get from a vector of cells [N], by their x and y.
struct Corners {
  Vec3 n00, n10, n01, n11;
};
HWY_INLINE Corners operator+(const Corners& a, const Corners& b) {
  return {a.n00 + b.n00, a.n10 + b.n10, a.n01 + b.n01, a.n11 + b.n11};
}
/// Corner (x, y), each -1 or 1, gets minus x a + y b + c + x y d.
HWY_INLINE Corners cornersOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 even = c + d, odd = c - d, sum = a + b, difference = a - b;
  return {sum - even, zero3() - (odd + difference), difference - odd, zero3() - (even + sum)};
}

/// Writes the sums by node of a plane of a brick's cells. @param i  place of the vector's first cell in its plane
HWY_INLINE void writeSums(float* sums, int z, int i, const Corners& f) {
  const Tag d;
  // Rows are blocks of four: a shift within blocks is one along x, and what leaves a row goes to the brick beside.
  const auto write = [&](size_t part, int c, V rows, V rows_behind) HWY_ATTR {
    float* at = sums + sumsAt(part, z, c) + i;
    if (i == 0) {  // the first vector of the plane clears the rows behind its own
      for (int row = static_cast<int>(hn::MaxLanes(d)); row < kFifthRow + 4; row += 4)
        hn::StoreU(hn::Zero(Row()), Row(), at + row);
      hn::StoreU(rows, d, at);
    } else {
      hn::StoreU(hn::Add(load(at), rows), d, at);
    }
    hn::StoreU(hn::Add(load(at + 4), rows_behind), d, at + 4);
  };
  for (int c = 0; c < 3; ++c) {
    const auto of = [c](const Vec3& v) HWY_ATTR { return c == 0 ? v.x : c == 1 ? v.y : v.z; };
    write(kOwnSums, c, hn::Add(of(f.n00), hn::ShiftLeftLanes<1>(d, of(f.n10))),
          hn::Add(of(f.n01), hn::ShiftLeftLanes<1>(d, of(f.n11))));
    write(kRightSums, c, hn::ShiftRightLanes<3>(d, of(f.n10)), hn::ShiftRightLanes<3>(d, of(f.n11)));
  }
}

/// Forces of a vector of cells on their corners, those below and those above.
/// @param cell  index of the first in the brick
template <bool kFull>
HWY_INLINE void pullOf(const CellJob& job, uint32_t b, int cell, V rigidity, V per_h, const PlaneStress& stress,
                       CellMotion q, Corners& low, Corners& high) {
  const size_t slot = size_t{b} * 64 + static_cast<size_t>(cell);
  const Shape shape = shapeOfEdges(q.da, q.db, q.dc);
  const V p = job.volumes ? pressureOf(load(job.bulk + slot), shape.e) : hn::Zero(Tag());
  const Moments moments = kFull ? Moments{zero3(), zero3(), zero3()} : loadMoments(job.moments[b] + cell);
  cellPull<kFull>(q, moments, rigidity, stress);
  const V quarter = hn::Mul(set(0.25f), per_h), half = hn::Mul(set(0.5f), per_h);
  const Vec3 a = quarter * mulAdd(p, shape.bc, q.da), bb = quarter * mulAdd(p, shape.ca, q.db);
  const Vec3 c = quarter * mulAdd(p, shape.ab, q.dc), hx = half * q.hx, hy = half * q.hy, hz = half * q.hz;
  const Vec3 alternating = hn::Mul(set(0.35355339f), per_h) * q.hxyz;
  low = cornersOf(a - hy, bb - hx, zero3() - c, hz - alternating);
  high = cornersOf(a + hy, bb + hx, c, hz + alternating);
}

void sumBrick(const CellJob& job, uint32_t b, const UpTile& u) {
  const layout::BodyParams& body = job.arrays.bodies[job.arrays.bricks[b].body];
  const V per_h = set(1 / body.origin_spacing.w);
  const V no = hn::Zero(Tag());
  PlaneStress stress = planeStress(set(body.rigidity_j > 0 ? body.bulk_j / body.rigidity_j : 0));
  float* sums = job.sums + size_t{b} * kCellSums;
  const Corners nothing = {zero3(), zero3(), zero3(), zero3()};
  for (int i = 0; i < 16; i += static_cast<int>(hn::MaxLanes(Tag()))) {
    Face below = faceAt(u, i);
    Corners upper = nothing;  // of the cells below the plane
    for (int z = 0; z < 4; ++z) {
      const Face above = faceAt(u, (z + 1) * kUpPlane + i);
      const int cell = 16 * z + i;
      const V rigidity = load(job.rigidity + size_t{b} * 64 + static_cast<size_t>(cell));
      const V bulk = load(job.bulk + size_t{b} * 64 + static_cast<size_t>(cell));
      Corners low = nothing, high = nothing;
      if (!hn::AllTrue(Tag(), hn::And(hn::Eq(rigidity, no), hn::Eq(bulk, no)))) {
        if (job.parts) {
          stress = planeStress(hn::IfThenElseZero(hn::Gt(rigidity, no), hn::Div(bulk, hn::Max(rigidity, set(1e-30f)))));
        }
        const CellMotion q = motionBetween(below, above, per_h);
        if (job.moments[b] != nullptr)
          pullOf<false>(job, b, cell, rigidity, per_h, stress, q, low, high);
        else
          pullOf<true>(job, b, cell, rigidity, per_h, stress, q, low, high);
      }
      writeSums(sums, z, i, low + upper);
      upper = high;
      below = above;
    }
    writeSums(sums, 4, i, upper);
  }
}

void cellsOf(const CellJob& job, const uint32_t* bricks, size_t count) {
  UpTile u;
  for (size_t n = 0; n < count; ++n) {
    fillUp(job.arrays, bricks[n], u);
    sumBrick(job, bricks[n], u);
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(cellsOf);

BrickCells cellsFor(int64_t target) {
  return VISCERA_KERNEL_FOR(cellsOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
