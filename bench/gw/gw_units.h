// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Texture units of the study's own kernels, beside those that they share with the solver's (layout/bindings.h): numbers
// that none of the latter has which are in a program with them.
#ifndef VISCERA_BENCH_GW_UNITS_H
#define VISCERA_BENCH_GW_UNITS_H
#include "layout/bindings.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kUnitInverseMass = 3u;  // r32f [nodes] 1/kg; 0 where fixed
const uint kUnitForces = 5u;       // rgba32f [nodes] N, or the texture that was blended into
const uint kUnitLinkForces = 12u;  // rgba32f [2 * springs or springs] N
const uint kUnitSprings = 15u;     // rgba32ui, as kBindSprings

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
