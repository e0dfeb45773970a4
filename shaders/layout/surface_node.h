// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What kernels know of the nodes that the surface mesh of a lattice follows.
#ifndef VISCERA_LAYOUT_SURFACE_NODE_H
#define VISCERA_LAYOUT_SURFACE_NODE_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A node with an approximate normal that at least one vertex follows.
struct SurfaceNode {
  uint slot;
  float normal_x, normal_y, normal_z;  // at rest, unit
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
