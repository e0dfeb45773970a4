// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Patterns of marks on tissue, shared by shaders/draw/marks.glsl and markPieces(): numbers of MarkPattern, and lengths in half
// widths of a mark's line.
#ifndef VISCERA_LAYOUT_MARK_PATTERNS_H
#define VISCERA_LAYOUT_MARK_PATTERNS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kDashed = 1.0f, kDouble = 2.0f, kCrossed = 3.0f, kThin = 4.0f;  // values of MarkPattern
const float kDashPeriod = 12.0f, kDash = 7.0f;         // a dash begins where the line does
const float kDoubleOff = 1.9f, kDoubleHalf = 0.8f;     // distance of each of the two lines from the middle, and half its width
const float kCrossPeriod = 10.0f, kFirstCross = 2.5f;  // distances of crosses along the line
const float kCrossArm = 3.2f, kCrossHalf = 0.8f;       // reach of a cross along and across, and half the width of its arms
const float kThinHalf = 0.5f;                          // half the width of a thin line, and of the line through crosses
const float kMarkBorder = 0.9f;                        // width of the dark border of lines

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
