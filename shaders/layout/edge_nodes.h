// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Nodes at the ends of springs that probes may touch anywhere along the spring (shaders/solver/tools/edges.glsl).
#ifndef VISCERA_LAYOUT_EDGE_NODES_H
#define VISCERA_LAYOUT_EDGE_NODES_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// Capacity per substep. If there are more, the probes are many cells wide and contact is with nodes alone.
const uint kMostEdgeNodes = 8192u;
// Rounds per probe and substep, at most; each uses the result of the previous one. More rounds change forces by less than three digits.
const uint kEdgeRounds = 6u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
