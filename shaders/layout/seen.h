// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Texture units of what tissue_seen.frag leaves for the passes behind it (render/seen_target.h), beyond those of bindings.h.
#ifndef VISCERA_LAYOUT_SEEN_H
#define VISCERA_LAYOUT_SEEN_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kUnitSeenDepths = 22u;    // depth
const uint kUnitSeenPlaces = 23u;    // rgba32ui: xyz place at rest, as bits of floats [m]; w see directionCode()
const uint kUnitSeenFinishes = 24u;  // rg32ui: x alpha's code << 24 and a texture chart or a wall's depth, y sRGB colour, and patches
const uint kUnitOver = 25u;          // sRGB colours times their alpha, and alpha: what lies over the tissue
const uint kUnitGrainSlopes = 26u;   // how steep the relief of the grain is: 128/255 not at all
// And of what shaders/draw/lens.frag bends (render/lens.h):
const uint kUnitSights = 27u;        // rg32f [image]: where in the pinhole's picture [px]
const uint kUnitPinhole = 28u;       // sRGB
const uint kUnitPinholeDepths = 29u; // r32f
const uint kUnitPinholeLabels = 30u; // r8ui

const uint kNoSeenChart = 0xffffffu;
const float kDeepestSeen_m = 0.25f;  // of a wall

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
