// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What pixels of a picture of labels say. 0: nothing is there.
#ifndef VISCERA_LAYOUT_PICTURE_LABELS_H
#define VISCERA_LAYOUT_PICTURE_LABELS_H
#include "viscera/layout/limits.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A thing's label is the first of its kind plus its index in the scene.
const uint kFirstBodyLabel = 1u;
const uint kFirstWallLabel = 101u;  // of wounds, by the index of the body
const uint kFirstToolLabel = 201u;
const uint kFirstObstacleLabel = 221u;
const uint kFirstThreadLabel = 241u;
const uint kClipLabel = 254u;

#ifdef __cplusplus
static_assert(kFirstBodyLabel + kMaxBodies <= kFirstWallLabel && kFirstWallLabel + kMaxBodies <= kFirstToolLabel &&
              kFirstToolLabel + kMaxStyluses <= kFirstObstacleLabel && kFirstObstacleLabel + kMaxObstacles <= kFirstThreadLabel);
}  // namespace viscera::layout
#endif
#endif
