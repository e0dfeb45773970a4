// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Displacements from nodes outside their tissue to its surface, one word each: three components and which of the edges along them exist. 0:
// the node is inside, or its cells are full.
#ifndef VISCERA_LAYOUT_SURFACE_WAYS_H
#define VISCERA_LAYOUT_SURFACE_WAYS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kOffsetBits = 9u;     // bits of a component; the lowest is x
const int kOffsetZero = 256;     // code of 0
const float kOffsetStep = 1.0f / 128.0f;  // step of a component, in cells: +-2 in total
const uint kOffsetEdgeBit = 1u << 27u;  // there is an edge from the node along x, towards the sign of the component; then y, z
// Largest distance of tissue from a node outside it, in cells: a cell's diagonal, and as much again where its edges are stretched or turned
// (shaders/solver/tissue/surface_offset.glsl).
const float kFarthestTissue = 3.5f;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
