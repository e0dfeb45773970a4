// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Primitives of overlays (surface/overlay/node_overlay.h).
#ifndef VISCERA_LAYOUT_OVERLAY_H
#define VISCERA_LAYOUT_OVERLAY_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A spring of a network as one of its ends sees it.
struct OverlayLink {
  uint far;       // slot of the other end
  uint spring;    // index of the spring among those of all networks
  float rest_length;  // [m], > 0
};

// A spring that is drawn, by the slots of its ends.
struct OverlayLine {
  uint a, b;
  uint spring;      // lattice: its index 0..17 from a; network: its index among the springs of all networks
  uint of_network;  // 0, 1
};

// A position at which a direction is drawn.
struct OverlaySpike {
  uint slot;
  uint vertex;  // 1 + the vertex of a network's surface mesh that has the normal; 0: the approximate normal of the node
};
const uint kSpikesAreNormals = 0u, kSpikesAreForces = 1u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
