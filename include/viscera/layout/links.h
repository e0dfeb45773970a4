// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Explicit connections between nodes.
#ifndef VISCERA_LAYOUT_LINKS_H
#define VISCERA_LAYOUT_LINKS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// Explicit connection as one of its two ends sees it.
struct Link {
  vec4 offset_length;  // xyz rest offset to the far end [m]; w rest length l0 [m]
  float stiffness;     // k [N/m]; 0 once it is cut
  float prestrain_m2;  // |offset|^2 - l0^2 [m2]: 0 for a spring that is at rest where its ends are
  uint far;            // slot of the far end
  uint lattice_spring;  // low 5 bits: in an explicit lattice the spring index 0..17 from this end, else kNoLatticeSpring or kBendingSpring
};
const uint kNoLatticeSpring = 31u;
const uint kBendingSpring = 30u;  // resists bending and is no edge of the surface: it spans two other springs
const uint kLatticeSpringMask = 31u;
const uint kForcePositionShift = 5u;  // in the link of the spring's owner, the bits of Link.lattice_spring above these: index of the spring's force on the far end

// Explicit connection, once per spring: slots of its ends, a < b, and its links there.
struct SpringEnds {
  uint a, b, link_a, link_b;
};
const uint kNoSpring = 0xffffffffu;
// Value of spring_cut and axial_cut for a spring that was erased together with one of its ends, not crossed by a blade: none of
// it is shown. The erased end is the one that has no spring left in its NodeBits.
const float kErasedShare = 2.0f;

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
