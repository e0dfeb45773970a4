// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Which nodes may touch others, in a number each: how deep the node lies below the surface of its tissue [m], less than 0
// outside of it; or one of these.
#ifndef VISCERA_LAYOUT_TOUCH_DEPTHS_H
#define VISCERA_LAYOUT_TOUCH_DEPTHS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kTouchesOnceCut = 1e30f;  // deep inside: once it has lost a spring, as if it lay on the surface
const float kNeverTouches = -1e30f;   // outside of its tissue, where others lie nearer to the surface

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
