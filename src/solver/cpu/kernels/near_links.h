// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/state/cpu_lattice.h"
#include "solver/cpu/state/parallel.h"
#include "viscera/layout/tool_motion.h"

namespace viscera {

/// Search for the explicit connections that a sweep of a blade may cross. Most are far from it and need no test by
/// shaders/solver/tools/cut_links.comp. Allocates nothing after the first call.
class NearLinks {
 public:
  /// @param parallel  for the search; must outlive this
  explicit NearLinks(const Parallel& parallel) : parallel_(parallel) {}
  /// Finds the positions of nodes relative to the sweep.
  /// @param slots  of nodes with explicit connections, the same in every call
  void find(CpuLattice& lattice, const std::vector<uint32_t>& slots, const layout::ToolMotion& motion);
  /// Returns whether a spring between two nodes may cross the sweep. If both are beyond the same side of the box around
  /// the sweep, it does not.
  bool mayCross(uint32_t slot, uint32_t other) const { return (outside_[slot] & outside_[other]) == 0; }
  /// Returns whether one of two nodes may be in an eraser's sweep.
  bool mayErase(uint32_t slot, uint32_t other) const { return outside_[slot] == 0 || outside_[other] == 0; }

 private:
  float fastest(const CpuLattice& lattice, const std::vector<uint32_t>& slots);

  const Parallel& parallel_;
  std::vector<float> reach_m_;    ///< [slots] largest distance of a node's tissue from the node [m]
  std::vector<float> fastest2_;   ///< [jobs] largest |v|^2 of its nodes [m2/s2]
  std::vector<uint8_t> outside_;  ///< [slots] sides of the box beyond which a node is, with its tissue, a bit each
};

}  // namespace viscera
