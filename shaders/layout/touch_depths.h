// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Codes of which nodes may touch others, one number each: the depth of the node below the surface of its tissue [m], negative outside it;
// or one of the constants below.
#ifndef VISCERA_LAYOUT_TOUCH_DEPTHS_H
#define VISCERA_LAYOUT_TOUCH_DEPTHS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kTouchesOnceCut = 1e30f;  // deep inside; touches as a surface node does once it has lost a spring
const float kNeverTouches = -1e30f;   // outside its tissue, where other nodes are nearer to the surface

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
