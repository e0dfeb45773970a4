// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/layout/nodes.h"

namespace viscera {

constexpr uint32_t kNoSlot = ~0u;

/// Returns the slot of the neighbour at an offset; its brick must exist (shaders/solver/tissue/lattice.glsl).
inline uint32_t neighborSlot(const std::vector<layout::Brick>& bricks, uint32_t slot,
                             const std::array<int, 3>& offset) {
  int direction = 0, inside = 0;
  constexpr int kDirection[3] = {1, 3, 9}, kShift[3] = {0, 2, 4};
  for (int axis = 0; axis < 3; ++axis) {
    const int at = static_cast<int>(slot >> kShift[axis] & 3) + offset[static_cast<size_t>(axis)];  // -1 .. 4
    direction += kDirection[axis] * ((at + 4) >> 2);
    inside |= (at & 3) << kShift[axis];
  }
  const layout::Brick& brick = bricks[slot / layout::kBrickSlots];
  return brick.neighbors[direction] * layout::kBrickSlots + static_cast<uint32_t>(inside);
}

/// Returns the same, or kNoSlot where there is no brick.
inline uint32_t slotBeside(const std::vector<layout::Brick>& bricks, uint32_t slot, const std::array<int, 3>& offset) {
  constexpr int kShift[3] = {0, 2, 4};
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const int at = static_cast<int>(slot >> kShift[axis] & 3) + offset[static_cast<size_t>(axis)];
    inside = inside && at >= 0 && at < 4;
  }
  const uint32_t out = neighborSlot(bricks, slot, offset);
  return !inside && out / layout::kBrickSlots == slot / layout::kBrickSlots ? kNoSlot : out;
}

}  // namespace viscera
