// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/tissue/joined_network.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/links.h"
#include "viscera/layout/nodes.h"

namespace viscera::simd {

constexpr size_t kGroupNodes = 16;  ///< slots on end that are stepped together; a brick has four such groups

/// The links of a network in rows: row r of a group has the r-th link of each of its 16 nodes, filled up where a node
/// has fewer. As wide as its node of most links, so nodes of like valence should lie together. What rows keep is most
/// of what a substep reads: of links that are all alike, as within lattices and sheets, it is kept once.
struct LinkRows {
  struct Row {
    uint32_t
        constants;   ///< where they begin: x, y, z of the rest offset, l0, prestrain, k; 1/l0^2 where they are alike
    uint16_t live;   ///< bit per node: it has a link there, which is not cut
    uint16_t alike;  ///< each constant is there once, not 16 times
  };
  LinkRows() = default;
  /// @param groups  of slots, ascending, that have explicit connections
  LinkRows(const JoinedNetwork& network, const std::vector<uint32_t>& groups);
  /// Takes over the stiffness of links that were cut, or made whole.
  void writeStiffness(const std::vector<layout::Link>& links);

  std::vector<uint32_t> groups;  ///< [groups] first slot / 16
  std::vector<uint32_t> starts;  ///< [groups + 1] rows
  std::vector<uint32_t> link;    ///< [16 * rows] index of the link, or kNone
  AlignedVector<int32_t>
      far;  ///< [16 * rows] four times the slot of the far end; of the near one where there is no link
  std::vector<Row> rows;
  AlignedVector<float> constants;  ///< of all rows
  static constexpr uint32_t kNone = 0xffffffffu;

 private:
  void addGroup(const JoinedNetwork& network, uint32_t group);
  void addRow(const std::vector<layout::Link>& links, const std::vector<uint32_t>& its);
};

struct NetworkJob {
  const LinkRows* rows;
  Substep step;
  bool dashpot;  ///< some body has one
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float* displacement;  ///< [3 * slots] m
  const float* velocity;      ///< [3 * slots] m/s
  float* places;              ///< [4 * slots] displacement once more, node by node, as far ends are looked up
  float* speeds;              ///< [4 * slots] velocity; null without dashpots
  float* next_displacement;
  float* next_velocity;
  float* compensation;            ///< [6 * slots], as in Arrays (kernels.h); or null
  const float* mobility;          ///< [slots] 1/kg
  const layout::NodeBits* nodes;  ///< [slots] as in Arrays
};

}  // namespace viscera::simd
