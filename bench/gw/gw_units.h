// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Texture units of the kernels of this study, in addition to those that they share with the solver's
// (layout/bindings.h). The numbers differ from all of the latter that are used in the same program.
#ifndef VISCERA_BENCH_GW_UNITS_H
#define VISCERA_BENCH_GW_UNITS_H
#include "layout/bindings.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kUnitInverseMass = 3u;  // r32f [nodes] 1/kg; 0 for fixed nodes
const uint kUnitForces = 5u;       // rgba32f [nodes] N, or the texture of the blending target
const uint kUnitLinkForces = 12u;  // rgba32f [2 * springs or springs] N
const uint kUnitSprings = 15u;     // rgba32ui, as kBindSprings

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
