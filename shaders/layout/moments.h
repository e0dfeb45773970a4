// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Numbers of cells by moments (physics.md 1): of shaders/solver/tissue/moments.glsl, its SIMD twin and the reference.
#ifndef VISCERA_LAYOUT_MOMENTS_H
#define VISCERA_LAYOUT_MOMENTS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// The energy fades out where tissue is far from any solid that it stands for, so that no start may gain by it: while one
// of the mean edges is shorter than kFadeFull, to nothing at kFadeNone; and with the size of the hourglass motions, to a half
// where their sum of squares is kFadeBend. The strain that their gradient is coupled to saturates: it is halved where its square
// is kFadeStrain2.
const float kFadeNone = 0.5f;
const float kFadeFull = 0.95f;
const float kFadeBend = 0.5f;
const float kFadeStrain2 = 0.5f;
// What the solid resists an alternating motion (hxyz) with, 5/18 mu h, the hexahedron's, less what the springs do, 1/2 mu h.
const float kAlternating = 5.0f / 18.0f - 0.5f;

// A corner of a cell is crushed where its three edges span less than the part kCrushed of their volume at rest. What it is pushed open
// with grows by kCrushing mu with what is missing, as much as leaves the frequencies of a cell that is squeezed to a half within those
// that a substep is made for, and not beyond kMostCrushed: there it has long been turned inside out.
const float kCrushed = 0.5f;
const float kMostCrushed = 1.5f;
const float kCrushing = 2.0f;
// No corner is while f + d is below the root of this, f^2 the sum of squares of what the mean edges changed by and d^2 of what a corner's
// differ from them by: a corner's span (1 - (f + d)/sqrt(3))^3 at least.
const float kNearRest2 = 0.125f;

// Numbers of a cell's bend in a thin wall: of its 9 hourglass motions with each other, row by row from the diagonal on, and of each
// with the 6 strains; in vectors of four.
const uint kBendPairs = 45u;
const uint kBendNumbers = 99u;
const uint kBendVectors = 25u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
