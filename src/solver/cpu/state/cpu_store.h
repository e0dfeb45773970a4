// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// The nodes and their arrangement: slots, bricks and bodies. Slots are those of the GPU backend (viscera/layout/).
struct CpuStore {
  /// @param bodies  [bodies] material constants
  CpuStore(const Model& model, const std::vector<layout::BodyParams>& bodies);

  const layout::BodyParams& bodyOf(uint32_t slot) const { return bodies[nodes[slot].hi >> layout::kBodyShift]; }
  layout::uint connections(uint32_t slot) const { return bodyOf(slot).connections; }
  size_t slotCount() const { return nodes.size(); }
  size_t brickCount() const { return bricks.size(); }

  std::vector<layout::Brick> bricks;          ///< [bricks] with neighbours numbered over all bodies
  std::vector<layout::BodyParams> bodies;     ///< [bodies]
  std::vector<layout::NodeBits> nodes;        ///< [slots] as on the GPU, body index included
  std::vector<layout::NodeBits> whole_nodes;  ///< [slots] the same with intact springs and without grips
  std::vector<uint32_t> active;               ///< [active] slots, ascending
  std::vector<uint32_t> first_active;         ///< [bricks + 1] where a brick's nodes begin in `active`
  std::vector<uint32_t> cells;                ///< [cells] slots of the lowest corners of filled cells, ascending
};

/// Returns the index of component 0 of a slot in arrays of vectors. These are stored brick by brick, one component
/// after the other: a plane of 4x4 nodes is 16 adjacent floats, and components are 64 apart.
constexpr size_t vectorAt(uint32_t slot) {
  return size_t{slot >> 6} * 192 + (slot & 63);
}

/// Returns the index of spring 2 * pair of a slot in CpuStrengths::stiffness.
constexpr size_t stiffnessAt(uint32_t slot, uint32_t pair) {
  return size_t{slot >> 6} * 576 + size_t{pair} * 64 + (slot & 63);
}

}  // namespace viscera
