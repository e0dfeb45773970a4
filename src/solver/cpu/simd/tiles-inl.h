// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A brick with its surroundings, and its springs and cells, for SIMD kernels. Included once per instruction set
// (Highway).
#if defined(VISCERA_SOLVER_CPU_TILES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_TILES_INL_H
#undef VISCERA_SOLVER_CPU_TILES_INL_H
#else
#define VISCERA_SOLVER_CPU_TILES_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

using Row = hn::FixedTag<float, 4>;

/// A brick and its surroundings, for each component of a vector. Rows are stored three times, shifted by -1, 0 and 1
/// along x, so that any neighbour is one load away. The value of the node at (x + dx, y, z), with x in 0..3 and y, z in
/// -1..4, is at[dx + 1][(z + 1) * kPlane + kOwn + 4 * y + x].
constexpr int kPlane = 48, kOwn = 16;
struct alignas(64) Tile {
  float component[3][3][6 * kPlane];
};

/// Copies rows of one plane of the brick, with its left and right neighbours, shifted by -1, 0 and 1.
template <class D>
HWY_INLINE void copyShifted(D d, const float* own, const float* left, const float* right, float* minus, float* zero,
                            float* plus) {
  const auto middle = hn::LoadU(d, own);
  hn::StoreU(middle, d, zero);
  hn::StoreU(hn::CombineShiftRightBytes<12>(d, middle, hn::LoadU(d, left)), d, minus);
  hn::StoreU(hn::CombineShiftRightBytes<4>(d, hn::LoadU(d, right), middle), d, plus);
}

/// Fills a tile from a brick and its neighbours.
/// @param corners  the bricks at opposite corners of cells are needed too: volumes depend on them, springs do not
template <bool corners>
HWY_INLINE void fill(const Arrays& a, const float* values, uint32_t b, Tile& tile) {
  constexpr int kFloats = 64;
  const Tag d;
  const Row row;
  const float* brick[27];
  for (int i = 0; i < 27; ++i) brick[i] = values + size_t{a.bricks[b].neighbors[i]} * (3 * kFloats);
  for (int c = 0; c < 3; ++c) {
    float *minus = tile.component[c][0], *zero = tile.component[c][1], *plus = tile.component[c][2];
    for (int z = -1; z <= 4; ++z) {
      const int side = z < 0 ? 0 : z > 3 ? 18 : 9;  // index among the 27 neighbours
      const int from = c * kFloats + (z & 3) * 16, to = (z + 1) * kPlane + kOwn;
      for (int i = 0; i < 16; i += static_cast<int>(hn::MaxLanes(d))) {
        copyShifted(d, brick[side + 4] + from + i, brick[side + 3] + from + i, brick[side + 5] + from + i,
                    minus + to + i, zero + to + i, plus + to + i);
      }
      if (corners || side == 9) {
        copyShifted(row, brick[side + 1] + from + 12, brick[side] + from + 12, brick[side + 2] + from + 12,
                    minus + to - 4, zero + to - 4, plus + to - 4);
        copyShifted(row, brick[side + 7] + from, brick[side + 6] + from, brick[side + 8] + from, minus + to + 16,
                    zero + to + 16, plus + to + 16);
      } else {
        hn::StoreU(hn::LoadU(row, brick[side + 1] + from + 12), row, zero + to - 4);
        hn::StoreU(hn::LoadU(row, brick[side + 7] + from), row, zero + to + 16);
      }
    }
  }
}

/// Returns the neighbours in direction (X, Y, Z) of the nodes at an index of the tile.
template <int X, int Y, int Z>
HWY_INLINE Vec3 seen(const Tile& tile, int at) {
  constexpr int kOffset = Z * kPlane + Y * 4;
  return {load(tile.component[0][1 + X] + at + kOffset), load(tile.component[1][1 + X] + at + kOffset),
          load(tile.component[2][1 + X] + at + kOffset)};
}
template <int sign>
HWY_INLINE V shifted(V value, V by) {
  return sign > 0 ? hn::Add(value, by) : sign < 0 ? hn::Sub(value, by) : value;
}
/// Returns value + (X, Y, Z) by.
template <int X, int Y, int Z>
HWY_INLINE Vec3 shifted(const Vec3& value, V by) {
  return {shifted<X>(value.x, by), shifted<Y>(value.y, by), shifted<Z>(value.z, by)};
}

/// Constants of a body, in all lanes.
struct Material {
  V h, h2;               ///< spacing and twice the spacing [m]
  V per_length2[2];      ///< 1 / l0^2 of axial and diagonal springs
  V dashpot_length2[2];  ///< c / (k l0^2)
  V full[2];             ///< stiffness of intact springs [N/m]
};
HWY_INLINE Material materialOf(const layout::BodyParams& body) {
  const float h = body.origin_spacing.w;
  Material m;
  m.h = set(h);
  m.h2 = set(2 * h);
  for (int kind = 0; kind < 2; ++kind) {
    m.per_length2[kind] = set(1 / (static_cast<float>(kind + 1) * h * h));
    m.dashpot_length2[kind] = set(body.dashpot_s / (static_cast<float>(kind + 1) * h * h));
  }
  m.full[0] = set(4 * body.axial_quarter_n_per_m);
  m.full[1] = set(2 * body.diagonal_half_n_per_m);
  return m;
}

// clang-format off
/// Calls APPLY(index, x, y, z) for the 18 springs in the order of model/body/neighbors.h.
#define VISCERA_SPRINGS(APPLY)                                                                    \
  APPLY(0, 1, 0, 0) APPLY(1, -1, 0, 0) APPLY(2, 0, 1, 0) APPLY(3, 0, -1, 0) APPLY(4, 0, 0, 1)     \
  APPLY(5, 0, 0, -1) APPLY(6, 1, 1, 0) APPLY(7, -1, -1, 0) APPLY(8, 1, -1, 0) APPLY(9, -1, 1, 0)  \
  APPLY(10, 1, 0, 1) APPLY(11, -1, 0, -1) APPLY(12, 1, 0, -1) APPLY(13, -1, 0, 1)                 \
  APPLY(14, 0, 1, 1) APPLY(15, 0, -1, -1) APPLY(16, 0, 1, -1) APPLY(17, 0, -1, 1)
// clang-format on

/// Returns V/V0 - 1 of cells.
/// @param n  displacements of their corners: bit 0 of the index is x, bit 1 y, bit 2 z
/// @param quarter  0.25 / h
HWY_INLINE V dilationOf(const Vec3 (&n)[8], V quarter) {
  const Vec3 da = quarter * (((n[1] - n[0]) + (n[3] - n[2])) + ((n[5] - n[4]) + (n[7] - n[6])));
  const Vec3 db = quarter * (((n[2] - n[0]) + (n[3] - n[1])) + ((n[6] - n[4]) + (n[7] - n[5])));
  const Vec3 dc = quarter * (((n[4] - n[0]) + (n[5] - n[1])) + ((n[6] - n[2]) + (n[7] - n[3])));
  const V minors =
      hn::Add(hn::Add(hn::MulSub(da.x, db.y, hn::Mul(da.y, db.x)), hn::MulSub(da.x, dc.z, hn::Mul(da.z, dc.x))),
              hn::MulSub(db.y, dc.z, hn::Mul(db.z, dc.y)));
  const V trace = hn::Add(hn::Add(da.x, db.y), dc.z);
  return hn::Add(trace, hn::Add(minors, dot(da, cross(db, dc))));
}

/// Collects the corners of the cells in which the nodes of a vector are corner (A, B, C).
/// @param where  arguments of seen()
template <int A, int B, int C, class... Where>
HWY_INLINE void cornersAround(Vec3 (&n)[8], const Where&... where) {
  n[0] = seen<-A, -B, -C>(where...);
  n[1] = seen<1 - A, -B, -C>(where...);
  n[2] = seen<-A, 1 - B, -C>(where...);
  n[3] = seen<1 - A, 1 - B, -C>(where...);
  n[4] = seen<-A, -B, 1 - C>(where...);
  n[5] = seen<1 - A, -B, 1 - C>(where...);
  n[6] = seen<-A, 1 - B, 1 - C>(where...);
  n[7] = seen<1 - A, 1 - B, 1 - C>(where...);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
