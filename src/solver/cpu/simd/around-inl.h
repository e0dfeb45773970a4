// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neighbours of a vector of nodes, for the pass over nodes. Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_AROUND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_AROUND_INL_H
#undef VISCERA_SOLVER_CPU_AROUND_INL_H
#else
#define VISCERA_SOLVER_CPU_AROUND_INL_H
#endif

#include "hwy/highway.h"
#include "solver/cpu/simd/tiles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3  // a vector is a plane

/// A brick and its neighbours, each as a pointer to its values. Values are read in place: shifting planes in registers
/// costs less than writing shifted copies.
struct Around {
  const float* brick[27];
};
HWY_INLINE void lookAround(const Arrays& a, const float* values, uint32_t b, Around& around) {
  for (int i = 0; i < 27; ++i) around.brick[i] = values + size_t{a.bricks[b].neighbors[i]} * 192;
}

/// The surroundings of a vector of nodes: the planes below, level with and above it.
struct Neighborhood {
  const float* const* middle[3];  ///< by plane: the middle one of its nine bricks
  int from[3];                    ///< by plane: its first value in the brick
};
/// Returns the surroundings of a vector of nodes.
/// @param i  index of the vector's first node in the brick
HWY_INLINE Neighborhood neighborhood(const Around& all, int i) {
  const int z = i >> 4;
  return {{all.brick + (z > 0 ? 13 : 4), all.brick + 13, all.brick + (z < 3 ? 13 : 22)},
          {((z - 1) & 3) * 16, z * 16, ((z + 1) & 3) * 16}};
}

/// Returns one component of the neighbours in direction (X, 0, Z) of a plane, in the brick that is Y bricks away along
/// y.
template <int X, int Y, int Z>
HWY_INLINE V seenBeside(const Neighborhood& s, int component) {
  const float* const* brick = s.middle[1 + Z] + 3 * Y;
  const int from = s.from[1 + Z] + component * 64;
  const V own = load(brick[0] + from);
  if (X < 0) return hn::CombineShiftRightBytes<12>(Tag(), own, load(brick[-1] + from));
  if (X > 0) return hn::CombineShiftRightBytes<4>(Tag(), load(brick[1] + from), own);
  return own;
}
template <int X, int Y, int Z>
HWY_INLINE V seenComponent(const Neighborhood& s, int component) {
  const V own = seenBeside<X, 0, Z>(s, component);
  if (Y == 0) return own;
  const __m512i near = _mm512_castps_si512(own.raw);
  const __m512i beyond = _mm512_castps_si512(seenBeside<X, Y, Z>(s, component).raw);
  return V{_mm512_castsi512_ps(Y < 0 ? _mm512_alignr_epi32(near, beyond, 12) : _mm512_alignr_epi32(beyond, near, 4))};
}
/// Returns the neighbours in direction (X, Y, Z).
template <int X, int Y, int Z>
HWY_INLINE Vec3 seen(const Neighborhood& s) {
  return {seenComponent<X, Y, Z>(s, 0), seenComponent<X, Y, Z>(s, 1), seenComponent<X, Y, Z>(s, 2)};
}

#else  // a vector is some rows of a plane

using Around = Tile;
HWY_INLINE void lookAround(const Arrays& a, const float* values, uint32_t b, Around& around) {
  fill<false>(a, values, b, around);
}
struct Neighborhood {
  const Tile& tile;
  int at;
};
HWY_INLINE Neighborhood neighborhood(const Around& all, int i) {
  return {all, ((i >> 4) + 1) * kPlane + kOwn + (i & 15)};
}
template <int X, int Y, int Z>
HWY_INLINE Vec3 seen(const Neighborhood& s) {
  return seen<X, Y, Z>(s.tile, s.at);
}

#endif

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
