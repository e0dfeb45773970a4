// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Explicit connections.
#ifndef VISCERA_LAYOUT_LINKS_H
#define VISCERA_LAYOUT_LINKS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// An explicit connection as one of its ends sees it.
struct Link {
  vec4 offset_length;  // xyz rest offset to the far end [m]; w rest length l0 [m]
  float stiffness;     // k [N/m]; 0 once it is cut
  float prestrain_m2;  // |offset|^2 - l0^2 [m2]: 0 for a spring that is at rest where its ends are
  uint far;            // slot of the far end
  uint lattice_spring; // low 5 bits: of an explicit lattice: its index 0..17 from this end; else one of the two below
};
const uint kNoLatticeSpring = 31u;
const uint kBendingSpring = 30u;  // none of the surface: it spans two others
const uint kLatticeSpringMask = 31u;
const uint kForcePlaceShift = 5u;  // Link.lattice_spring of a spring's owner: above these bits the place of its force on the far end

// An explicit connection once: slots of its ends, a < b, and its links there.
struct SpringEnds {
  uint a, b, link_a, link_b;
};
const uint kNoSpring = 0xffffffffu;
// spring_cut, and axial_cut, of a spring that was not crossed but erased, as one of its ends was: nothing of it is shown. Which
// end, NodeBits say: one that was erased has no spring left.
const float kErasedShare = 2.0f;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
