// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Edge-centric forces (solver/tissue/edge_forces.h).
#ifndef VISCERA_LAYOUT_EDGE_FORCES_H
#define VISCERA_LAYOUT_EDGE_FORCES_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A node that computes some of its springs, for their far ends too.
struct SpringOwner {
  uint slot;
  uint first, end;  // links of the springs that it owns
  uint place;       // of the sum of their forces on it; forces on it of springs that others own come behind
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
