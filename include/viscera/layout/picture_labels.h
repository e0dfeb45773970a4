// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Values of the pixels of a label image. 0: nothing is there.
#ifndef VISCERA_LAYOUT_PICTURE_LABELS_H
#define VISCERA_LAYOUT_PICTURE_LABELS_H
#include "viscera/layout/limits.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// The label of an object is the first label of its kind plus its index in the scene.
const uint kFirstBodyLabel = 1u;
const uint kFirstWallLabel = 101u;  // walls of wounds, by the index of the body
const uint kFirstToolLabel = 201u;
const uint kFirstObstacleLabel = 221u;
const uint kFirstSutureLabel = 241u;
const uint kClipLabel = 254u;

#ifdef __cplusplus
static_assert(kFirstBodyLabel + kMaxBodies <= kFirstWallLabel && kFirstWallLabel + kMaxBodies <= kFirstToolLabel &&
              kFirstToolLabel + kMaxStyluses <= kFirstObstacleLabel && kFirstObstacleLabel + kMaxObstacles <= kFirstSutureLabel);
}}  // namespace viscera::layout
#endif
#endif
