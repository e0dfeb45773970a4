// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Triangles that wind acts on.
#ifndef VISCERA_LAYOUT_WIND_H
#define VISCERA_LAYOUT_WIND_H
#include "viscera/layout/links.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A triangle (a, b, c) of a network's surface as node a sees it: the other corners, and the springs of its edges ab, bc, ca.
struct WindTriangle {
  uint b, c;
  uint springs[3];  // kNoSpring where there is no spring along the edge
  uint pad;
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
