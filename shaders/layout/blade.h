// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Reach of a blade, shared by shaders/solver/tools/blade.glsl and the code that searches for what is near a blade.
#ifndef VISCERA_LAYOUT_BLADE_H
#define VISCERA_LAYOUT_BLADE_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kOverlap = 1e-3f;  // overlap of sweeps, as a share of the tip's path: a sweep begins this far before the end of the last, against rounding
const float kLongest = 8.0f;   // reach of a blade, in rest lengths of a diagonal: a spring with an end farther from the blade is not cut

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
