// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What overlays are made of (surface/overlay/node_overlay.h).
#ifndef VISCERA_LAYOUT_OVERLAY_H
#define VISCERA_LAYOUT_OVERLAY_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// A spring of a network as one of its ends sees it.
struct OverlayLink {
  uint far;       // slot of the other end
  uint spring;    // of all networks
  float rest_length;  // [m], > 0
};

// A spring that is drawn: slots of its ends.
struct OverlayLine {
  uint a, b;
  uint spring;      // of a lattice: its index 0..17 from a; of a network: of all networks
  uint of_network;  // 0, 1
};

// A place that a direction is drawn at.
struct OverlaySpike {
  uint slot;
  uint vertex;  // of a network's skin: 1 + vertex whose normal is drawn; else 0: the approximate normal of the node
};
const uint kSpikesAreNormals = 0u, kSpikesAreForces = 1u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
