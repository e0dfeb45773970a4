// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "viscera/layout/limits.h"
#include "viscera/layout/nodes.h"
#include "viscera/math/types.h"

namespace viscera {

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

}  // namespace viscera
