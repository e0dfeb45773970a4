// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// How a skin follows its nodes.
#ifndef VISCERA_LAYOUT_SKIN_H
#define VISCERA_LAYOUT_SKIN_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A skin vertex bound to the lattice (EGVE eqs 4 to 9).
struct SkinBinding {
  uint slot0, slot1, slot2;
  uint springs;            // spring index of edges 01, 12, 20 (5 bits each); flags below
  vec4 weights;            // xyz barycentric weights; w offset along the approximate normal [m], with kAlongNormalBit
  vec4 offset_constant;    // xyz offset in (T, N, B) of the triangle [m]
  vec4 offset_interpolated;  // xyz offset in (T_c, N_c, B_c) [m]
  vec4 normal_constant;      // xyz shading normal in (T, N, B)
  vec4 normal_interpolated;  // xyz shading normal in (T_c, N_c, B_c)
};
const uint kInterpolatedBit = 1u << 31;
// Of SkinBinding.springs: while none of its springs is cut, the vertex moves with the eight corners of the cell that holds it, of which
// slot0 is the one in the three bits from kCornerShift on. Where it lies in the cell follows from offset_constant.
const uint kInCellBit = 1u << 29;
const uint kCornerShift = 16u;
// Of SkinBinding.springs: a vertex of a network's skin, which is its node slot0; normal_constant is its normal at rest.
const uint kOneToOneBit = 1u << 30;
// Of SkinBinding.springs: a vertex that goes with the node slot0 of a lattice (EGVE 3.2). Its offset stays as it is at rest; it is shaded
// by the node's approximate normal.
const uint kOneNodeBit = 1u << 28;
// Of SkinBinding.springs: a vertex that lies along the interpolated approximate normal, which also shades it (EGVE 3.5).
const uint kAlongNormalBit = 1u << 27;
// Of SkinBinding.springs, with one of these two: shaded by its own normal in (T, N, B) all the same, as the walls of a wound are.
const uint kOwnNormalBit = 1u << 26;

// Of a triangle on which no texture lies.
const uint kNoTextureChart = 0xffffffffu;

// What is shown of a triangle.
const uint kShownWhole = 1u;
const uint kShownCorner = 2u;  // << corner 0, 1, 2: the piece at a corner that a cut has parted from the others
const uint kShownRest = 16u;   // << corner: the two triangles that are left without that corner

// An approximate normal is a sum of unit vectors (VR05 eq 5): 0 inside the body, 1 on a concave edge, 3.8 on a flat
// face. Trust in it grows from 0 to 1 between these two lengths of the sum.
const float kNormalSumNone = 0.25f;
const float kNormalSumFull = 0.75f;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
