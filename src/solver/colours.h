// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/joined_network.h"

namespace viscera {

/// Which nodes vbd may move at once (physics.md 2). Springs join none of the four colours 2 ((i + j) & 1) + ((j + k) &
/// 1); a cell's energy of volume joins its opposite corners too, so with volumes the eight parities of (i, j, k) are
/// needed. Bricks start at multiples of four, so the parities of a node's coordinates are those within its brick.
constexpr uint32_t colourOf(uint32_t slot, bool volume) {
  const uint32_t i = slot & 1, j = (slot >> 2) & 1, k = (slot >> 4) & 1;
  return volume ? i + 2 * j + 4 * k : 2 * ((i + j) & 1) + ((j + k) & 1);
}
constexpr uint32_t colourCount(bool volume) {
  return volume ? 8 : 4;
}

/// Nodes colour by colour.
struct Coloured {
  struct Colour {
    uint32_t first, count;  ///< in slots
  };
  std::vector<uint32_t> slots;
  std::vector<Colour> colours;
};

/// Nodes with explicit connections are coloured greedily, in the order of their slots; where there is energy of volume,
/// nodes of different parities share none of these colours either, as they might share a cell.
/// @param active  [active] slots   @param volume  there is energy of volume   @param network  explicit connections
Coloured byColour(const std::vector<uint32_t>& active, bool volume, const JoinedNetwork& network);

}  // namespace viscera
