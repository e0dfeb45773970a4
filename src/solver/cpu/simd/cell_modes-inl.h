// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Deformation modes of a vector of cells, with the names of shaders/solver/tissue/cell_modes.glsl. Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_CELL_MODES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_CELL_MODES_INL_H
#undef VISCERA_SOLVER_CPU_CELL_MODES_INL_H
#else
#define VISCERA_SOLVER_CPU_CELL_MODES_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Mean edges minus their rest value, over h; hourglass motions as sums and differences of displacements [m]. These are
/// 2 h times those of cell_modes.glsl, hxyz sqrt(8) h times.
struct CellModes {
  Vec3 da, db, dc, hx, hy, hz, hxyz;
};

/// Nodes of a face of cells: sums (s) and differences (d) along x and along y.
struct Face {
  Vec3 ss, sd, ds, dd;
};
HWY_INLINE Face faceOf(const Vec3& n00, const Vec3& n10, const Vec3& n01, const Vec3& n11) {
  const Vec3 s0 = n00 + n10, d0 = n10 - n00, s1 = n01 + n11, d1 = n11 - n01;
  return {s0 + s1, s1 - s0, d0 + d1, d1 - d0};
}
/// Returns the deformation modes of displacements over 4 h.
HWY_INLINE CellModes motionOf4(const Face& low, const Face& high) {
  return {low.ds + high.ds, low.sd + high.sd, high.ss - low.ss, high.sd - low.sd,
          high.ds - low.ds, low.dd + high.dd, high.dd - low.dd};
}
}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
