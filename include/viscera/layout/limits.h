// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Largest numbers of objects, and the storage scheme of nodes.
#ifndef VISCERA_LAYOUT_LIMITS_H
#define VISCERA_LAYOUT_LIMITS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// Lattice nodes are stored in bricks of 4x4x4 slots: slot = 64 * brick + x + 4 y + 16 z (coordinates within the brick).
const uint kBrickEdge = 4u;
const uint kBrickSlots = 64u;
const uint kSpringsPerNode = 18u;
const uint kAxialSprings = 6u;
const uint kMaxStyluses = 2u;
const uint kMaxBodies = 16u;
const uint kMaxObstacles = 16u;
const uint kGroupSize = 64u;

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
