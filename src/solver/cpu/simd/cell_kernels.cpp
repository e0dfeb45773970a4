// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "solver/cpu/simd/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/cell_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/law_bricks-inl.h"
#include "solver/cpu/simd/targets.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Returns the planes of nodes, one bit each, below and above rows of cells.
HWY_INLINE uint32_t planesOf(uint32_t rows) {
  uint32_t planes = 0;
  for (int z = 0; z < 4; ++z) planes |= (rows >> (4 * z) & 15) != 0 ? 3u << z : 0u;
  return planes;
}

void cellsOf(const CellJob& job, const uint32_t* bricks, size_t count) {
  UpTile tile;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t b = bricks[n], next = bricks[std::min(n + 1, count - 1)];
    const layout::BodyParams& params = job.arrays.bodies[job.arrays.bricks[b].body];
    lawBrick(job, params, b, next, planesOf(~uint32_t{job.idle_rows[b]}), tile);
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
