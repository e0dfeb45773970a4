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

constexpr size_t kGroupNodes = 16;  ///< adjacent slots that are stepped together; a brick has four such groups

/// The links of a network in rows. Row r of a group has the r-th link of each of its 16 nodes, with padding for nodes
/// with fewer links. A group has as many rows as its node with most links, so nodes of similar valence should be
/// adjacent. Most memory that a substep reads is rows. The constants of a row of equal links, common in lattices and
/// sheets, are therefore stored once.
struct LinkRows {
  struct Row {
    uint32_t constants;  ///< where they begin: x, y, z of the rest offset, l0, prestrain, k; plus 1/l0^2 in rows of
                         ///< equal links
    uint16_t live;       ///< bit per node: it has a link there that is not cut
    uint16_t alike;      ///< 1: each constant is stored once, not 16 times
  };
  LinkRows() = default;
  /// @param groups  those with explicit connections, ascending
  LinkRows(const JoinedNetwork& network, const std::vector<uint32_t>& groups);
  /// Copies the stiffness of links after cuts or repairs.
  void writeStiffness(const std::vector<layout::Link>& links);

  std::vector<uint32_t> groups;  ///< [groups] first slot / 16
  std::vector<uint32_t> starts;  ///< [groups + 1] first row of each
  std::vector<uint32_t> link;    ///< [16 * rows] index of the link, or kNone
  AlignedVector<int32_t>
      far;  ///< [16 * rows] four times the slot of the far end; of the near end where there is no link
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
  bool dashpot;  ///< at least one body has a dashpot
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float* displacement;  ///< [3 * slots] m
  const float* velocity;      ///< [3 * slots] m/s
  float* positions;           ///< [4 * slots] copy of displacement, node by node, for lookup by far ends
  float* speeds;              ///< [4 * slots] velocity; null without dashpots
  float* next_displacement;
  float* next_velocity;
  float* compensation;            ///< [6 * slots], as in Arrays (kernels.h); or null
  const float* mobility;          ///< [slots] 1/kg
  const layout::NodeBits* nodes;  ///< [slots] as in Arrays
};

}  // namespace viscera::simd
