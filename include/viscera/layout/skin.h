// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Binding of a surface mesh to its nodes.
#ifndef VISCERA_LAYOUT_SKIN_H
#define VISCERA_LAYOUT_SKIN_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// Vertex of a surface mesh, bound to the lattice (EGVE eqs 4 to 9).
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
// Flag of SkinBinding.springs: while none of its springs is cut, the vertex moves with the eight corners of the cell around it. slot0 is
// the corner that the three bits from kCornerShift on name; offset_constant gives the position in the cell.
const uint kInCellBit = 1u << 29;
const uint kCornerShift = 16u;
// Flag of SkinBinding.springs: the vertex of a network's surface is its node slot0; normal_constant is its normal at rest.
const uint kOneToOneBit = 1u << 30;
// Flag of SkinBinding.springs: the vertex moves with the lattice node slot0 (EGVE 3.2). Its offset stays as at rest; the node's
// approximate normal shades it.
const uint kOneNodeBit = 1u << 28;
// Flag of SkinBinding.springs: the vertex is offset along the interpolated approximate normal, which also shades it (EGVE 3.5).
const uint kAlongNormalBit = 1u << 27;
// Flag of SkinBinding.springs, with one of these two: the vertex's own normal in (T, N, B) shades it, as on the walls of a wound.
const uint kOwnNormalBit = 1u << 26;

// Chart of a triangle without a texture.
const uint kNoTextureChart = 0xffffffffu;

// Pieces of a triangle that are shown.
const uint kShownWhole = 1u;
const uint kShownCorner = 2u;  // << corner 0, 1, 2: the piece at a corner that a cut has separated from the others
const uint kShownRest = 16u;  // << corner: the two triangles that remain without that corner

// An approximate normal is a sum of unit vectors (VR05 eq 5). Its length is 0 inside the body, 1 on a concave edge and 3.8 on a
// flat face. The weight of the normal rises from 0 to 1 between these two lengths.
const float kNormalSumNone = 0.25f;
const float kNormalSumFull = 0.75f;

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
