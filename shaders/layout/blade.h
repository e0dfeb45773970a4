// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// How far a blade reaches: of shaders/solver/tools/blade.glsl and of who looks for what is near one.
#ifndef VISCERA_LAYOUT_BLADE_H
#define VISCERA_LAYOUT_BLADE_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kOverlap = 1e-3f;  // of the tip's way: a sweep begins that much before the end of the last one, whatever is rounded
const float kLongest = 8.0f;   // rest lengths of a diagonal: a spring with an end farther from the blade is not cut

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
