// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forces of the cells of bricks with a hyperelastic law, including cells that have lost a spring. Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_LAW_BRICKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_LAW_BRICKS_INL_H
#undef VISCERA_SOLVER_CPU_LAW_BRICKS_INL_H
#else
#define VISCERA_SOLVER_CPU_LAW_BRICKS_INL_H
#endif

#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "solver/cpu/simd/cells-inl.h"
#include "solver/cpu/simd/law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Loads (u + dashpot_s v) / (4 h) of the nodes of a brick and of the plane above it (fillUp()). The forces of cells
/// are those at the predicted positions of their corners, which damps (docs/physics.md 2).
template <bool kDashpot>
HWY_INLINE void fillScaled(const Arrays& a, uint32_t b, uint32_t planes, const LawBody& body, UpTile& tile) {
  const V scale = set(body.scale), ahead = set(body.dashpot_s * body.scale);
  fillUp(a, b, planes, tile, [&](size_t at) HWY_ATTR {
    const V u = hn::Mul(scale, load(a.displacement + at));
    return kDashpot ? hn::MulAdd(ahead, load(a.velocity + at), u) : u;
  });
}

struct LawBrick {
  const CellJob& job;
  const layout::BodyParams& params;
  const LawBody& body;
  const UpTile& tile;
  uint32_t b;
};

// clang-format off
/// Calls APPLY(number, near, far, x, y, z) for the springs within a cell (kBrokenSprings), from corner to corner: bit
/// per axis, x lowest.
#define VISCERA_SPRINGS_WITHIN(APPLY)                                                                          \
  APPLY(0, 0, 1, 1, 0, 0) APPLY(1, 2, 3, 1, 0, 0) APPLY(2, 4, 5, 1, 0, 0) APPLY(3, 6, 7, 1, 0, 0)              \
  APPLY(4, 0, 2, 0, 1, 0) APPLY(5, 1, 3, 0, 1, 0) APPLY(6, 4, 6, 0, 1, 0) APPLY(7, 5, 7, 0, 1, 0)              \
  APPLY(8, 0, 4, 0, 0, 1) APPLY(9, 1, 5, 0, 0, 1) APPLY(10, 2, 6, 0, 0, 1) APPLY(11, 3, 7, 0, 0, 1)            \
  APPLY(12, 0, 3, 1, 1, 0) APPLY(13, 4, 7, 1, 1, 0) APPLY(14, 2, 1, 1, -1, 0) APPLY(15, 6, 5, 1, -1, 0)        \
  APPLY(16, 0, 5, 1, 0, 1) APPLY(17, 2, 7, 1, 0, 1) APPLY(18, 4, 1, 1, 0, -1) APPLY(19, 6, 3, 1, 0, -1)        \
  APPLY(20, 0, 6, 0, 1, 1) APPLY(21, 1, 7, 0, 1, 1) APPLY(22, 4, 2, 0, 1, -1) APPLY(23, 5, 3, 0, 1, -1)
// clang-format on

/// Returns the constants of springs in units of 4 h for lengths, with stiffness in N per unit.
HWY_INLINE Material springsWithin() {
  Material m{};
  m.h = set(0.25f);
  m.h2 = set(0.5f);
  for (int kind = 0; kind < 2; ++kind) m.per_length2[kind] = set(16.0f / static_cast<float>(kind + 1));
  return m;
}

/// Returns the index, among a broken cell's numbers, of the shortening of a spring at rest relative to the lattice.
constexpr uint32_t shorterAt(uint32_t number) {
  return kBrokenSprings + (number < 12 ? number / 4 : 3 + (number - 12) / 2);
}

/// Computes L^2/l0^2 - 1 of a spring with rest length l0 / sqrt(1 + more).
/// @param w  u_far - u_near, over 4 h
template <int X, int Y, int Z>
HWY_INLINE V growthOf(const Material& m, V more, const Vec3& w) {
  constexpr int kKind = X * X + Y * Y + Z * Z - 1;
  const V q = hn::Mul(dot(w, shifted<X, Y, Z>(w, m.h2)), m.per_length2[kKind]);
  return hn::Add(hn::MulAdd(q, more, q), more);
}

/// Adds the forces of the remaining springs of broken cells, as derivatives by the cells' modes.
/// @param k  numbers of the first cell (CpuStrengths::broken); the next are 16 farther
inline HWY_NOINLINE void addBroken(const float* k, const Corners& low, const Corners& high, CellModes& out) {
  const Vec3 n[8] = {low.n00, low.n10, low.n01, low.n11, high.n00, high.n10, high.n01, high.n11};
  Vec3 f[8] = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  const Material m = springsWithin();
#define VISCERA_PULL(number, near, far, X, Y, Z)                                                       \
  {                                                                                                    \
    const V of_spring = load(k + 16 * (number)), more = load(k + 16 * shorterAt(number));              \
    const Vec3 w = n[far] - n[near];                                                                   \
    const V q = hn::IfThenElseZero(hn::Gt(of_spring, hn::Zero(Tag())), growthOf<X, Y, Z>(m, more, w)); \
    const V pull = hn::Mul(of_spring, hn::Mul(q, anyPhi(q)));                                          \
    const M collapsed = hn::Lt(hn::Add(set(1), q), set(kShortest2));                                   \
    const Vec3 e = select(collapsed, shifted<X, Y, Z>(zero3(), m.h), shifted<X, Y, Z>(w, m.h));        \
    const V along = hn::IfThenElse(collapsed, hn::Neg(of_spring), pull);                               \
    f[near] = mulAdd(along, e, f[near]);                                                               \
    f[far] = mulAdd(hn::Neg(along), e, f[far]);                                                        \
  }
  VISCERA_SPRINGS_WITHIN(VISCERA_PULL)
#undef VISCERA_PULL
  // Forces with a sum of zero are those of the seven modes: -1/8 sum of sign times force.
  const V eighth = set(-0.125f);
  const Face below = faceOf(f[0], f[1], f[2], f[3]), above = faceOf(f[4], f[5], f[6], f[7]);
  const CellModes sum = motionOf4(below, above);
  out.da = mulAdd(eighth, sum.da, out.da);
  out.db = mulAdd(eighth, sum.db, out.db);
  out.dc = mulAdd(eighth, sum.dc, out.dc);
  out.hx = mulAdd(eighth, sum.hx, out.hx);
  out.hy = mulAdd(eighth, sum.hy, out.hy);
  out.hz = mulAdd(eighth, sum.hz, out.hz);
  out.hxyz = mulAdd(eighth, sum.hxyz, out.hxyz);
}

/// Computes the contributions of a vector of cells to its corners.
/// @param cell  index of the first cell in the brick
template <bool kFull>
HWY_NOINLINE void lawCells(const LawBrick& of, int cell, V rigidity, const Face& below, const Face& above,
                           CellModes& out) {
  const V mu = hn::Mul(rigidity, of.body.per_4h);
  const CellModes q = motionOf4(below, above);
  const float* tension = of.job.tension[of.b];
  if (HWY_UNLIKELY(tension != nullptr)) tension += cellNumberAt(static_cast<uint32_t>(cell), 0, kTensionNumbers);
  const float* laminate = kFull ? nullptr : of.job.laminates[of.b];
  if (HWY_UNLIKELY(laminate != nullptr)) laminate += cellNumberAt(static_cast<uint32_t>(cell), 0, kLaminateNumbers);
  const LawMoments moments = kFull ? LawMoments{zero3(), zero3(), zero3()} : loadLawMoments(of.job.moments[of.b], cell);
  if (HWY_LIKELY(!of.job.parts)) {
    lawForces<kFull>(of.body, moments, tension, laminate, mu, q, out);
    return;
  }
  const V bulk = load(of.job.bulk + size_t{of.b} * 64 + static_cast<size_t>(cell));
  const M there = hn::Gt(rigidity, hn::Zero(Tag()));
  const V ratio = hn::IfThenElseZero(there, hn::Div(bulk, hn::Max(rigidity, set(1e-30f))));
  LawBody body = lawBodyOf(of.params, ratio, of.job.dashpot);
  lawForces<kFull>(body, moments, tension, laminate, mu, q, out);
}

/// Contributions of the four vectors of cells of a column.
/// @param i  index of the column's vectors in their planes
struct LawColumn {
  CellModes cells[4];
  const CellModes* at[6];  ///< contributions below and above a plane of nodes
};
HWY_INLINE void stepLawColumn(const LawBrick& of, int i, const CellModes& nothing, LawColumn& column) {
  Face faces[2];
  int known = -1;  // last plane with a computed face
  column.at[0] = column.at[5] = &nothing;
  for (int z = 0; z < 4; ++z) {
    const int cell = 16 * z + i, at = z * kUpPlane + i;
    CellModes& out = column.cells[z];
    column.at[z + 1] = &nothing;
    if (noRows(~uint32_t{of.job.idle_rows[of.b]}, cell)) continue;
    const V rigidity = load(of.job.rigidity + size_t{of.b} * 64 + static_cast<size_t>(cell));
    const float* broken = of.job.broken[of.b];
    if (!hn::AllTrue(Tag(), hn::Eq(rigidity, hn::Zero(Tag())))) {
      if (known < z) faces[z & 1] = faceAt(of.tile, at);
      faces[(z + 1) & 1] = faceAt(of.tile, at + kUpPlane);
      known = z + 1;
      column.at[z + 1] = &out;
      if (noRows(of.job.partial_rows[of.b], cell))
        lawCells<true>(of, cell, rigidity, faces[z & 1], faces[(z + 1) & 1], out);
      else
        lawCells<false>(of, cell, rigidity, faces[z & 1], faces[(z + 1) & 1], out);
    }
    if (HWY_LIKELY(broken == nullptr)) continue;
    if (column.at[z + 1] == &nothing) out = nothing;
    column.at[z + 1] = &out;
    addBroken(broken + cellNumberAt(static_cast<uint32_t>(cell), 0, kBrokenNumbers), cornersAt(of.tile, at),
              cornersAt(of.tile, at + kUpPlane), out);
  }
}

/// Sums the forces of a brick's cells by node.
/// @param planes  bit z: plane of nodes on which cells may act; the sums of other planes are 0 and stay 0
HWY_INLINE void sumLawBrick(const LawBrick& of, uint32_t planes) {
  const CellModes nothing = {zero3(), zero3(), zero3(), zero3(), zero3(), zero3(), zero3()};
  LawColumn column;
  float* sums = of.job.sums + size_t{of.b} * kCellSums;
  Behind behind;
  for (int i = 0; i < 16; i += static_cast<int>(hn::MaxLanes(Tag()))) {
    stepLawColumn(of, i, nothing, column);
    for (int z = 0; z <= 4; ++z) {
      if (planes >> z & 1) writeSums(sums, behind, z, i, gathered(*column.at[z], *column.at[z + 1]));
    }
  }
}

/// Computes the sums of one brick.
/// @param next  the brick after it, for prefetching
HWY_INLINE void lawBrick(const CellJob& job, const layout::BodyParams& params, uint32_t b, uint32_t next,
                         uint32_t planes, UpTile& tile) {
  const V ratio = set(params.rigidity_j > 0 ? params.bulk_j / params.rigidity_j : 0);
  const LawBody body = lawBodyOf(params, ratio, job.dashpot);
  if (job.dashpot)
    fillScaled<true>(job.arrays, b, planes, body, tile);
  else
    fillScaled<false>(job.arrays, b, planes, body, tile);
  for (size_t i = 0; i < 192; i += 16) hwy::Prefetch(job.arrays.displacement + size_t{next} * 192 + i);
  for (size_t i = 0; i < kCellSums; i += 16) hwy::Prefetch(job.sums + size_t{next} * kCellSums + i);
  sumLawBrick({job, params, body, tile, b}, planes);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
