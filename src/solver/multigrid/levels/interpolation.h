// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "solver/multigrid/levels/elements.h"

namespace viscera::multigrid {

/// What a node of a level takes from those of the next coarser one, and the other way round.
struct Transfer {
  std::vector<uint32_t> starts, parents;  ///< [nodes + 1], [entries] coarse nodes of a node, by place, x fastest
  std::vector<float> weights;             ///< [entries] 1, 1/2, 1/4 or 1/8
  std::vector<uint32_t> coarse_starts, children;  ///< [coarse nodes + 1], [entries] the same by coarse node
  std::vector<float> coarse_weights;
};

/// Two nodes of a level that pull at each other.
using Link = std::pair<uint32_t, uint32_t>;

/// Finds the nodes of the next coarser level. It has twice the spacing, and a node takes trilinearly from the places
/// around it. Of the nodes that take from a place, those that links join take from one coarse node there: the sides of
/// a cut from two. Links along the rim of the cube of nodes that take from a place do not join what reaches through it
/// to the other rim: else whatever holds the sides together at the front of a cut would close it a cell further on each
/// level, and coarse levels, on which the cut is shorter, would not know how its sides part.
class Interpolation {
 public:
  /// @param takes  [nodes] others take from none
  Interpolation(const LevelNodes& nodes, const std::vector<uint8_t>& takes, const std::vector<Link>& links);

  LevelNodes coarse;  ///< in the order of bodies, z, y, x
  Transfer transfer;

 private:
  enum class Joins { kInside, kWithinRims, kToRims };
  uint32_t find(uint32_t entry);
  void join(const Link& link, Joins joins);
  void number();
  void gatherChildren();

  const LevelNodes& nodes_;
  std::vector<uint32_t> starts_;  ///< [nodes + 1] of their entries, one for each place that a node takes from
  std::vector<uint32_t> of_;      ///< [entries] an entry at the same place that it is joined with
  std::vector<uint8_t> within_;   ///< [entries] rims in which all that are joined with it lie
  std::vector<uint8_t> reach_;    ///< [entries] rims in which some of them lie
};

}  // namespace viscera::multigrid
