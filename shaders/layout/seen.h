// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Texture units of the images that tissue_g_buffer.frag writes for later passes (render/g_buffer.h). They follow those of bindings.h.
#ifndef VISCERA_LAYOUT_SEEN_H
#define VISCERA_LAYOUT_SEEN_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const uint kUnitSeenDepths = 22u;    // depth
const uint kUnitSeenPositions = 23u;  // rgba32ui: xyz rest position, as bits of floats [m]; w see directionCode()
const uint kUnitSeenFinishes = 24u;  // rg32ui: x code of alpha << 24 and a texture chart or a wall's depth, y sRGB colour and patches
const uint kUnitOver = 25u;          // sRGB colours times alpha, and alpha: what is drawn over the tissue
const uint kUnitGrainSlopes = 26u;   // slope of the relief of the grain: 128/255 is flat
// Texture units of the images that shaders/draw/lens.frag distorts (render/lens.h):
const uint kUnitSights = 27u;        // rg32f [image]: position in the image of the pinhole camera [px]
const uint kUnitPinhole = 28u;       // sRGB
const uint kUnitPinholeDepths = 29u; // r32f
const uint kUnitPinholeLabels = 30u; // r8ui
// Texture units of shaders/draw/marks.glsl (surface/marks/mark_textures.h):
const uint kUnitMarkCells = 31u;     // r32ui: MarkGrid::cells
const uint kUnitMarkSegments = 32u;  // rgba32f: MarkGrid::segments
const uint kUnitMarkStyles = 33u;    // rgba32f: linear colour, MarkPattern

const uint kNoSeenChart = 0xffffffu;
const uint kSeenPaint = 0xfffffeu;  // in place of a chart: paint hides textures and marks
const float kDeepestSeen_m = 0.25f;  // largest depth of a wall that is stored [m]

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
