// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Nodes at the ends of springs that probes may touch between their ends (shaders/solver/tools/edges.glsl).
#ifndef VISCERA_LAYOUT_EDGE_NODES_H
#define VISCERA_LAYOUT_EDGE_NODES_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// In a substep. Where there are more, the probes are many cells wide, and nodes alone are met.
const uint kMostEdgeNodes = 8192u;
// Of a probe in a substep, at most: each sees what the one before did. With more, forces are the same to three digits.
const uint kEdgeRounds = 6u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
