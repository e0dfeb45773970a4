// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "hwy/cache_control.h"
#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/cell_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/cells-inl.h"
#include "solver/cpu/simd/crushed-inl.h"
#include "solver/cpu/simd/law_bricks-inl.h"
#include "solver/cpu/simd/moments-inl.h"
#include "solver/cpu/simd/targets.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Constants of a body.
struct CellBody {
  Material springs;
  CellScale scale;
  PlaneStress<true> full;
  PlaneStress<false> partial;

  template <bool kFull>
  const PlaneStress<kFull>& stress() const {
    if constexpr (kFull)
      return full;
    else
      return partial;
  }
};
HWY_INLINE CellBody cellBodyOf(const layout::BodyParams& body) {
  const V ratio = set(body.rigidity_j > 0 ? body.bulk_j / body.rigidity_j : 0);
  return {materialOf(body), cellScale(body.origin_spacing.w), planeStress<true>(ratio), planeStress<false>(ratio)};
}

/// A brick whose cells are summed.
struct CellBrick {
  const CellJob& job;
  const CellBody& body;
  const CellTiles& tiles;
  uint32_t b, next;  ///< next: the one after it
};

/// Has what a plane of cells needs fetched: the processor does not look that far ahead by itself, as much is done with
/// few numbers.
template <bool kDashpot>
HWY_INLINE void prefetchPlane(const CellJob& job, uint32_t b, int plane) {
  // Its nodes, and of those that tiles reach to the ones that come last in the order of bricks.
  const uint32_t* const around = job.arrays.bricks[b].neighbors;
  for (const int direction : {13, 16, 22}) {
    if (direction == 22 && plane > 0) break;
    const size_t from = size_t{around[direction]} * 192 + static_cast<size_t>(16 * plane);
    for (size_t c = 0; c < 3; ++c) hwy::Prefetch(job.arrays.displacement + from + c * 64);
    for (size_t c = 0; c < 3 && kDashpot; ++c) hwy::Prefetch(job.arrays.velocity + from + c * 64);
  }
  if ((~uint32_t{job.idle_rows[b]} >> (4 * plane) & 15) == 0) return;
  for (int c = 0; c < 3; ++c) hwy::Prefetch(job.sums + size_t{b} * kCellSums + ownSumsAt(plane, c));
  const uint32_t cell = static_cast<uint32_t>(16 * plane), slot = b * 64 + cell;
  hwy::Prefetch(job.rigidity + slot);
  if (job.volumes) hwy::Prefetch(job.bulk + slot);
  for (uint32_t s = 0; s < kCellSprings && !job.uniform[b]; ++s) hwy::Prefetch(job.springs + cellSpringAt(slot, s));
  if ((job.partial_rows[b] >> (4 * plane) & 15) == 0) return;
  for (uint32_t m = 0; m < kMomentNumbers; ++m) hwy::Prefetch(job.moments[b] + cellNumberAt(cell, m, kMomentNumbers));
}

/// Springs of a vector of cells, see addSprings(). @param cell  index of the first in the brick
template <bool kUniform, bool kAny, bool kDashpot>
HWY_NOINLINE bool springsOf(const CellBrick& of, int cell, const Corners& below, Corners& low, Corners& high) {
  const float* k = of.job.springs + cellSpringAt(of.b * 64 + static_cast<uint32_t>(cell), 0);
  const int at = (cell >> 4) * kUpPlane + (cell & 15);
  return addSprings<kUniform, kAny, kDashpot>(of.body.springs, k, of.tiles, at, below, low, high);
}
template <bool kDashpot>
HWY_INLINE void springsOf(const CellBrick& of, int cell, const Corners& below, Corners& low, Corners& high) {
  // What was strained in the last substep is taken to be so still; which formula counts is the state's affair alone.
  const uint32_t bit = 1u << (cell / 4);
  uint16_t& strained = of.job.strained[of.b];
  if (HWY_UNLIKELY((strained & bit) != 0)) {
    if (!springsOf<false, true, kDashpot>(of, cell, below, low, high)) return;
    strained = static_cast<uint16_t>(strained & ~bit);
  }
  const bool mild = of.job.uniform[of.b] ? springsOf<true, false, kDashpot>(of, cell, below, low, high)
                                         : springsOf<false, false, kDashpot>(of, cell, below, low, high);
  if (HWY_LIKELY(mild)) return;
  springsOf<false, true, kDashpot>(of, cell, below, low, high);
  strained = static_cast<uint16_t>(strained | bit);
}

/// What a vector of cells does to its corners, by their motion.
/// @param cell  index of the vector's first cell in the brick   @param q  forces by the motion, see cellPull()
template <bool kFull>
HWY_NOINLINE void cellForces(const CellBrick& of, int cell, V rigidity, V bulk, M absent, const Face& below,
                             const Face& above, CellMotion& out) {
  const CellScale& scale = of.body.scale;
  PlaneStress<kFull> of_part;
  const PlaneStress<kFull>* stress = &of.body.template stress<kFull>();
  if (HWY_UNLIKELY(of.job.parts)) {
    const M there = hn::Gt(rigidity, hn::Zero(Tag()));
    of_part = planeStress<kFull>(hn::IfThenElseZero(there, hn::Div(bulk, hn::Max(rigidity, set(1e-30f)))));
    stress = &of_part;
  }
  CellMotion q = motionBetween(below, above, hn::IfThenZeroElse(absent, scale.per_4h));
  if (of.job.volumes) {
    const Shape shape = shapeOfEdges(q.da, q.db, q.dc);
    const V p = hn::Mul(scale.per_4h, pressureOf(bulk, shape.e));
    out.da = p * shape.bc;
    out.db = p * shape.ca;
    out.dc = p * shape.ab;
  }
  const Moments moments = kFull ? Moments{zero3(), zero3(), zero3()} : loadMoments(of.job.moments[of.b], cell);
  const ThinWalls walls = kFull ? ThinWalls{} : thinWallsOf(of.job, of.b, cell);
  const bool may_be_crushed = mayBeCrushed(q, hn::Gt(rigidity, hn::Zero(Tag())), scale.per_4h2);
  cellPull<kFull>(q, moments, walls, rigidity, *stress, scale);
  if (of.job.volumes) {
    q.da = q.da + out.da;
    q.db = q.db + out.db;
    q.dc = q.dc + out.dc;
  }
  out = q;
  if (HWY_LIKELY(!may_be_crushed)) return;
  const CellMotion motion = motionBetween(below, above, hn::IfThenZeroElse(absent, scale.per_4h));
  addCrushed(motion, rigidity, scale.per_4h, out);
}

/// A column of four vectors of cells, and of the five planes of their nodes.
struct Column {
  Corners below[5];               ///< what nodes get of the springs of the cells below them
  Corners springs[4];             ///< and of those above them too
  Face faces[5];                  ///< where nodes are; of cells that are there
  CellMotion cells[4];            ///< what these do
  const Corners* springs_at[5];   ///< of a plane of nodes
  const CellMotion* cells_at[6];  ///< below and above a plane of nodes
};

/// What the nodes of a plane get from cells and springs.
HWY_INLINE Corners gathered(const Corners& springs, const CellMotion& below, const CellMotion& above) {
  const Corners cells = gathered(below, above);
  return {springs.n00 + cells.n00, springs.n10 + cells.n10, springs.n01 + cells.n01, springs.n11 + cells.n11};
}

/// @param i  place of the column's vectors in their planes   @param none, nothing  0
template <bool kDashpot>
HWY_INLINE void stepColumn(const CellBrick& of, int i, const Corners& none, const CellMotion& nothing, Column& column) {
  const CellJob& job = of.job;
  const V no = hn::Zero(Tag());
  const Corners* below = &none;
  column.cells_at[0] = column.cells_at[5] = &nothing;
  int known = -1;  // last plane whose face is
  for (int z = 0; z < 4; ++z) {
    const int cell = 16 * z + i, at = z * kUpPlane + i;
    if (i == 0) prefetchPlane<kDashpot>(job, of.next, z);
    column.springs_at[z] = below;
    column.cells_at[z + 1] = &nothing;
    if (noRows(~uint32_t{job.idle_rows[of.b]}, cell)) {
      below = &none;
      continue;
    }
    springsOf<kDashpot>(of, cell, *below, column.springs[z], column.below[z + 1]);
    column.springs_at[z] = &column.springs[z];
    below = &column.below[z + 1];
    const size_t slot = size_t{of.b} * 64 + static_cast<size_t>(cell);
    const V rigidity = load(job.rigidity + slot), bulk = job.volumes ? load(job.bulk + slot) : no;
    const M absent = hn::And(hn::Eq(rigidity, no), hn::Eq(bulk, no));
    if (hn::AllTrue(Tag(), absent)) continue;
    if (known < z) column.faces[z] = faceAt(of.tiles.u, at);
    column.faces[z + 1] = faceAt(of.tiles.u, at + kUpPlane);
    known = z + 1;
    column.cells_at[z + 1] = &column.cells[z];
    if (noRows(job.partial_rows[of.b], cell))
      cellForces<true>(of, cell, rigidity, bulk, absent, column.faces[z], column.faces[z + 1], column.cells[z]);
    else
      cellForces<false>(of, cell, rigidity, bulk, absent, column.faces[z], column.faces[z + 1], column.cells[z]);
  }
  column.springs_at[4] = below;
}

/// @param planes  bit z: of nodes, which cells may do something to; the others' sums are 0 and stay so
template <bool kDashpot>
HWY_INLINE void sumBrick(const CellBrick& of, uint32_t planes) {
  const Corners none = noCorners();
  const CellMotion nothing = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  Column column;
  float* sums = of.job.sums + size_t{of.b} * kCellSums;
  Behind behind;
  for (int i = 0; i < 16; i += static_cast<int>(hn::MaxLanes(Tag()))) {
    stepColumn<kDashpot>(of, i, none, nothing, column);
    for (int z = 0; z <= 4; ++z) {
      if ((planes >> z & 1) == 0) continue;
      writeSums(sums, behind, z, i, gathered(*column.springs_at[z], *column.cells_at[z], *column.cells_at[z + 1]));
    }
  }
}

/// Planes of nodes, bit per plane, below and above rows of cells.
HWY_INLINE uint32_t planesOf(uint32_t rows) {
  uint32_t planes = 0;
  for (int z = 0; z < 4; ++z) planes |= (rows >> (4 * z) & 15) != 0 ? 3u << z : 0u;
  return planes;
}

void cellsOf(const CellJob& job, const uint32_t* bricks, size_t count) {
  CellTiles tiles;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t b = bricks[n], next = bricks[std::min(n + 1, count - 1)];
    const layout::BodyParams& params = job.arrays.bodies[job.arrays.bricks[b].body];
    const uint32_t planes = planesOf(~uint32_t{job.idle_rows[b]});
    if (params.law != layout::kLawSprings) {
      lawBrick(job, params, b, next, planes, tiles.u);
      continue;
    }
    const CellBody body = cellBodyOf(params);
    fillUp(job.arrays, job.arrays.displacement, b, planes, tiles.u);
    if (job.dashpot) {
      fillUp(job.arrays, job.arrays.velocity, b, planes, tiles.v);
      sumBrick<true>({job, body, tiles, b, next}, planes);
    } else {
      sumBrick<false>({job, body, tiles, b, next}, planes);
    }
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
