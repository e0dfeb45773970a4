// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Ways from nodes that lie outside of their tissue to its surface, in a word each: three numbers and which of the edges
// along them exist. 0: the node lies within, or its cells are full.
#ifndef VISCERA_LAYOUT_SURFACE_WAYS_H
#define VISCERA_LAYOUT_SURFACE_WAYS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kWayBits = 9u;        // of a component, the lowest is x
const int kWayZero = 256;        // stands for 0
const float kWayStep = 1.0f / 128.0f;  // of one, in cells: +-2 in all
const uint kWayEdgeBit = 1u << 27u;    // from the node along x, to the side of the way, goes an edge; then y, z
// Tissue of a node outside is that many cells away at most: a cell's diagonal, and as much again where its edges are stretched or
// turned (shaders/solver/tissue/surface_way.glsl).
const float kFarthestTissue = 3.5f;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
