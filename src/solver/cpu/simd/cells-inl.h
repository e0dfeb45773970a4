// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The corners of cells, gathered from nodes, and sums by node of the forces of cells on their corners. Included once
// per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_CELLS_INL_H
#undef VISCERA_SOLVER_CPU_CELLS_INL_H
#else
#define VISCERA_SOLVER_CPU_CELLS_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/cell_modes-inl.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/simd/springs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Displacements or velocities of the nodes of a brick and of the plane above it, unshifted and shifted by 1 along x
/// and y. The node at (x, y, z) + (dx, dy, 0), with x, y in 0..3 and z in 0..4, is at[dx][dy][z * kUpPlane + 4 * y +
/// x]. So every load reads what one store wrote, within one cache line.
constexpr int kUpPlane = 16;
struct alignas(64) UpTile {
  float component[3][2][2][5 * kUpPlane];
};

/// Returns the rows of a vector from its second on, followed by the first row of the next vector.
HWY_INLINE V rowsAfter(V rows, V next) {
  const Tag d;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  return hn::BitCast(
      d, hn::Vec<hn::RebindToSigned<Tag>>{_mm512_alignr_epi32(hn::BitCast(hn::RebindToSigned<Tag>(), next).raw,
                                                              hn::BitCast(hn::RebindToSigned<Tag>(), rows).raw, 4)});
#else
  if constexpr (hn::MaxLanes(Tag()) == 4) {
    return next;
  } else {
    return hn::ConcatLowerUpper(d, next, rows);
  }
#endif
}

/// Fills a tile from the brick and its neighbours.
/// @param planes  bit z: plane z is needed
/// @param get  returns the vector of numbers at an index of Arrays' fields
template <class Get>
HWY_INLINE void fillUp(const Arrays& a, uint32_t b, uint32_t planes, UpTile& tile, const Get& get) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  const Tag d;
  const uint32_t* around = a.bricks[b].neighbors;
  for (int z = 0; z <= 4; ++z) {
    if ((planes >> z & 1) == 0) continue;
    const int layer = 13 + 9 * (z >> 2);
    const size_t own = size_t{around[layer]} * 192, right = size_t{around[layer + 1]} * 192;
    const size_t behind = size_t{around[layer + 3]} * 192, corner = size_t{around[layer + 4]} * 192;
    for (int c = 0; c < 3; ++c) {
      const auto from = static_cast<size_t>(64 * c + (z & 3) * 16);
      const auto shifted = [&](size_t at_right, V at, size_t i)
                               HWY_ATTR { return hn::CombineShiftRightBytes<4>(d, get(at_right + from + i), at); };
      V here = get(own + from), here_right = shifted(right, here, 0);
      for (int i = 0; i < 16; i += kLanes) {
        const bool last = i + kLanes == 16;
        const int to = z * kUpPlane + i;
        const size_t after = last ? 0 : static_cast<size_t>(i + kLanes);
        const V next = get((last ? behind : own) + from + after);
        const V next_right = shifted(last ? corner : right, next, after);
        hn::Store(here, d, tile.component[c][0][0] + to);
        hn::Store(here_right, d, tile.component[c][1][0] + to);
        hn::Store(rowsAfter(here, next), d, tile.component[c][0][1] + to);
        hn::Store(rowsAfter(here_right, next_right), d, tile.component[c][1][1] + to);
        here = next;
        here_right = next_right;
      }
    }
  }
}

/// Values of the four corners of cells at one height, by their x and y.
struct Corners {
  Vec3 n00, n10, n01, n11;
};
template <int kX, int kY>
HWY_INLINE Vec3 upAt(const UpTile& tile, int at) {
  const auto of = [&](int c) HWY_ATTR { return hn::Load(Tag(), tile.component[c][kX][kY] + at); };
  return {of(0), of(1), of(2)};
}
HWY_INLINE Corners cornersAt(const UpTile& tile, int at) {
  return {upAt<0, 0>(tile, at), upAt<1, 0>(tile, at), upAt<0, 1>(tile, at), upAt<1, 1>(tile, at)};
}

// A vector consists of rows of four lanes; shifts of lanes stay within them.

/// Returns the last row of a vector.
template <class D>
HWY_INLINE hn::Vec<Row> lastRow(D /*d*/, hn::Vec<D> v) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return v;
  } else {
    const hn::Half<D> half;
    return lastRow(half, hn::UpperHalf(half, v));
  }
}
/// Returns a vector that begins with a row and is 0 elsewhere.
template <class D>
HWY_INLINE hn::Vec<D> firstRow(D d, hn::Vec<Row> row) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return row;
  } else {
    return hn::ZeroExtendVector(d, firstRow(hn::Half<D>(), row));
  }
}
/// Moves every row to the place of the next one; the first becomes 0.
template <class D>
HWY_INLINE hn::Vec<D> nextRow(D d, hn::Vec<D> v) {
  constexpr size_t kLanes = hn::MaxLanes(D());
  if constexpr (kLanes == 4) {
    return hn::Zero(d);
  } else if constexpr (kLanes == 8) {
    return hn::ConcatLowerLower(d, v, hn::Zero(d));
  } else {
    alignas(64) static constexpr int32_t kFrom[16] = {0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    return hn::IfThenZeroElse(hn::FirstN(d, 4), hn::TableLookupLanes(v, hn::SetTableIndices(d, kFrom)));
  }
}
/// Returns [x3, y3, z3, 0] of each row.
template <class D>
HWY_INLINE hn::Vec<D> lastOfRows(D d, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z) {
  const hn::RepartitionToWide<D> wide;
  const auto xy = hn::BitCast(wide, hn::InterleaveUpper(d, x, y));
  const auto z0 = hn::BitCast(wide, hn::InterleaveUpper(d, z, hn::Zero(d)));
  return hn::BitCast(d, hn::InterleaveUpper(wide, xy, z0));
}

/// Returns the nodes of the lowest faces of a vector of cells.
/// @param at  index of the first node in the tile
HWY_INLINE Face faceAt(const UpTile& tile, int at) {
  const Corners n = cornersAt(tile, at);
  return faceOf(n.n00, n.n10, n.n01, n.n11);
}

/// Returns the sums, at the nodes of a plane, of the contributions of the cells below and above it.
HWY_INLINE Corners gathered(const CellModes& below, const CellModes& above) {
  const Vec3 ss = above.dc - below.dc, sd = (above.hx - above.db) - (below.hx + below.db);
  const Vec3 ds = (above.hy - above.da) - (below.hy + below.da);
  const Vec3 dd = (above.hxyz - above.hz) - (below.hxyz + below.hz);
  const Vec3 even = ss + dd, odd = ss - dd, sum = sd + ds, difference = sd - ds;
  return {even - sum, odd - difference, odd + difference, even + sum};
}

/// Contributions of the last rows of a vector of cells to the row behind them, kept for the next vector of their plane.
struct alignas(16) Behind {
  float own[5][3][4], right[5][4];
};

/// Adds `behind` to the rows one farther along y. The first row gets what the previous vector left in `kept`. The part
/// beyond the last row is stored in `kept` in turn or, at the end of the plane, in `end`.
HWY_INLINE V withBehind(V own, V behind, int i, float* kept, float* end) {
  const Tag d;
  const Row row;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  V sum = hn::Add(own, nextRow(d, behind));
  if (kLanes < 16 && i > 0) sum = hn::Add(sum, firstRow(d, hn::Load(row, kept)));
  hn::StoreU(lastRow(d, behind), row, i + kLanes < 16 ? kept : end);
  return sum;
}

/// Writes the sums (ownSumsAt and the others) of a plane of nodes. Vectors must come in order.
/// @param i  index of the vector's first cell in its plane
/// @param f  contributions to the corners of its cells there
HWY_INLINE void writeSums(float* sums, Behind& behind, int z, int i, const Corners& f) {
  const Tag d;
  for (int c = 0; c < 3; ++c) {
    const V own = hn::Add(component(f.n00, c), hn::ShiftLeftLanes<1>(d, component(f.n10, c)));
    const V farther = hn::Add(component(f.n01, c), hn::ShiftLeftLanes<1>(d, component(f.n11, c)));
    hn::StoreU(withBehind(own, farther, i, behind.own[z][c], sums + behindSumsAt(z, c)), d, sums + ownSumsAt(z, c) + i);
  }
  const V right = lastOfRows(d, f.n10.x, f.n10.y, f.n10.z), farther = lastOfRows(d, f.n11.x, f.n11.y, f.n11.z);
  hn::StoreU(withBehind(right, farther, i, behind.right[z], sums + cornerSumsAt(z)), d, sums + rightSumsAt(z) + i);
}

/// Pointers to the sums for a brick's nodes: its own and those of the bricks below along x, y and z, bit per axis.
struct CellSources {
  const float* of[8];
};
HWY_INLINE CellSources sourcesOf(const Arrays& a, uint32_t b) {
  alignas(64) static constexpr float kNothing[kCellSums] = {};
  CellSources out;
  for (int below = 0; below < 8; ++below) {
    const int direction = 13 - (below & 1) - 3 * (below >> 1 & 1) - 9 * (below >> 2);
    const uint32_t brick = a.bricks[b].neighbors[direction];
    out.of[below] = brick == b && below != 0 ? kNothing : a.cell_sums + size_t{brick} * kCellSums;
  }
  return out;
}

/// Returns in the first lane of each row its component C, of rows [x, y, z, 0] of lastOfRows().
template <int C, class D>
HWY_INLINE hn::Vec<D> firstOfRows(D d, hn::Vec<D> packed) {
  alignas(64) static constexpr uint32_t kFirst[16] = {~0u, 0, 0, 0, ~0u, 0, 0, 0, ~0u, 0, 0, 0, ~0u, 0, 0, 0};
  if constexpr (C == 2) {
    return hn::ShiftRightLanes<2>(d, packed);  // the lanes after it are 0
  } else {
    const auto mask = hn::BitCast(d, hn::Load(hn::RebindToUnsigned<D>(), kFirst));
    return hn::And(mask, C == 0 ? packed : hn::ShiftRightLanes<1>(d, packed));
  }
}

/// Returns the force of the surrounding cells on the nodes of a vector.
/// @param i  index of the vector's first node in the brick
HWY_INLINE Vec3 forceOfCells(const CellSources& sources, int i) {
  const Tag d;
  const Row row;
  Vec3 force = zero3();
  for (int below = 0; below < ((i >> 4) == 0 ? 8 : 4); below += 4) {
    const int plane = below == 4 ? 4 : i >> 4, rows = i & 15;
    const float* own = sources.of[below] + rows;
    force =
        force + Vec3{load(own + ownSumsAt(plane, 0)), load(own + ownSumsAt(plane, 1)), load(own + ownSumsAt(plane, 2))};
    const V left = load(sources.of[below + 1] + rightSumsAt(plane) + rows);
    force = force + Vec3{firstOfRows<0>(d, left), firstOfRows<1>(d, left), firstOfRows<2>(d, left)};
    if (rows != 0) continue;
    const float* front = sources.of[below + 2];
    const auto corner = hn::LoadU(row, sources.of[below + 3] + cornerSumsAt(plane));
    const auto first = [&](int c, hn::Vec<Row> of_corner) HWY_ATTR {
      return firstRow(d, hn::Add(hn::LoadU(row, front + behindSumsAt(plane, c)), of_corner));
    };
    force = force + Vec3{first(0, firstOfRows<0>(row, corner)), first(1, firstOfRows<1>(row, corner)),
                         first(2, firstOfRows<2>(row, corner))};
  }
  return force;
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
