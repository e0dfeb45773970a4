// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/nodes.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Offsets of the 18 neighbours of a lattice node, in the order of the spring index: six axial, then twelve
/// face-diagonal. Spring s, seen from its other end, is s ^ 1. shaders/solver/tissue/lattice.glsl lists the same order.
constexpr std::array<std::array<int, 3>, layout::kSpringsPerNode> kNeighborOffsets = {{
    {1, 0, 0},
    {-1, 0, 0},
    {0, 1, 0},
    {0, -1, 0},
    {0, 0, 1},
    {0, 0, -1},
    {1, 1, 0},
    {-1, -1, 0},
    {1, -1, 0},
    {-1, 1, 0},
    {1, 0, 1},
    {-1, 0, -1},
    {1, 0, -1},
    {-1, 0, 1},
    {0, 1, 1},
    {0, -1, -1},
    {0, 1, -1},
    {0, -1, 1},
}};

constexpr uint32_t oppositeSpring(uint32_t spring) {
  return spring ^ 1u;
}
constexpr bool isAxial(uint32_t spring) {
  return spring < layout::kAxialSprings;
}

/// Returns the spring index of the neighbour at `offset` (components -1, 0, 1), or -1 where no spring joins the two.
int springIndex(const Vector3i& offset);

/// Returns the strength of a spring as a small count: axial 0..4 quarters, diagonal 0..2 halves; 0: cut or absent.
inline uint32_t springCount(const layout::NodeBits& bits, uint32_t spring) {
  return isAxial(spring) ? (bits.lo >> (3u * spring)) & 7u : (bits.hi >> (2u * (spring - 6u))) & 3u;
}
void setSpringCount(layout::NodeBits& bits, uint32_t spring, uint32_t count);

inline uint32_t massEighths(const layout::NodeBits& bits) {
  return (bits.lo >> layout::kMassShift) & 15u;
}
inline bool isFixed(const layout::NodeBits& bits) {
  return (bits.lo & layout::kFixedBit) != 0;
}

/// Returns whether a slot is a ghost (RowGhost): no node of the tissue.
inline bool isGhost(const layout::NodeBits& bits) {
  return (bits.lo & layout::kGhostBit) != 0;
}
/// Returns the spring index from a ghost towards its fixed node.
inline uint32_t springOfGhost(const layout::NodeBits& bits) {
  return (bits.lo >> layout::kGhostRowShift) & 7u;
}
/// Returns whether a node is the end of a row along an axis that goes on to a ghost.
inline bool hasGhost(const layout::NodeBits& bits, int axis) {
  return !isGhost(bits) && ((bits.lo >> (layout::kGhostRowShift + static_cast<uint32_t>(axis))) & 1u) != 0;
}
/// Returns the spring index from such a node, with all its springs whole, to the ghost.
inline uint32_t springToGhost(const layout::NodeBits& whole, int axis) {
  const auto first = static_cast<uint32_t>(2 * axis);
  return springCount(whole, first) == 0 ? first : first + 1;
}
/// Returns whether a node has a second difference along an axis: both springs along it are intact, or one of them and
/// the other neighbour is a ghost.
inline bool isWithinRow(const layout::NodeBits& bits, int axis) {
  const auto first = static_cast<uint32_t>(2 * axis);
  return (springCount(bits, first) != 0) + (springCount(bits, first + 1) != 0) + hasGhost(bits, axis) >= 2;
}

}  // namespace viscera
