// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a vector of cells moves: shaders/solver/tissue/cell_motion.glsl, whose names these are. Included once per
// instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_CELL_MOTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_CELL_MOTION_INL_H
#undef VISCERA_SOLVER_CPU_CELL_MOTION_INL_H
#else
#define VISCERA_SOLVER_CPU_CELL_MOTION_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Mean edges less their rest value, over h; hourglass motions as sums and differences of displacements [m], which is
/// 2 h times those of cell_motion.glsl and, hxyz, sqrt(8) h.
struct CellMotion {
  Vec3 da, db, dc, hx, hy, hz, hxyz;
};

/// Nodes of a face of cells, summed and differed along x and y.
struct Face {
  Vec3 ss, sd, ds, dd;
};
HWY_INLINE Face faceOf(const Vec3& n00, const Vec3& n10, const Vec3& n01, const Vec3& n11) {
  const Vec3 s0 = n00 + n10, d0 = n10 - n00, s1 = n01 + n11, d1 = n11 - n01;
  return {s0 + s1, s1 - s0, d0 + d1, d1 - d0};
}
/// Of displacements over 4 h.
HWY_INLINE CellMotion motionOf4(const Face& low, const Face& high) {
  return {low.ds + high.ds, low.sd + high.sd, high.ss - low.ss, high.sd - low.sd,
          high.ds - low.ds, low.dd + high.dd, high.dd - low.dd};
}
}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
