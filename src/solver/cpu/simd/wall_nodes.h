// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera::simd {

// Order of the nodes and edge ends of a cell in a thin wall (kWallNodes, kWallEnds in kernels.h).

/// Returns the lower corner of an edge along an axis, at sides 0 or 1 along the next axis and the one after it.
constexpr uint32_t lowerCorner(int axis, int side, int other) {
  return static_cast<uint32_t>(side << ((axis + 1) % 3) | other << ((axis + 2) % 3));
}
constexpr uint32_t upperCorner(int axis, int side, int other) {
  return lowerCorner(axis, side, other) | 1u << axis;
}
/// Returns the index of the node beyond a corner along an axis, outwards.
constexpr uint32_t nodeBeyond(uint32_t corner, int axis) {
  return 8 + 3 * corner + static_cast<uint32_t>(axis);
}
/// Returns the index of the weight of an edge's lower end; that of its upper end follows.
constexpr uint32_t endsAt(int axis, int side, int other) {
  return static_cast<uint32_t>(8 * axis + 4 * side + 2 * other);
}

}  // namespace viscera::simd
