// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/store/cpu_lattice.h"
#include "solver/cpu/store/parallel.h"
#include "viscera/layout/tool_motion.h"

namespace viscera {

/// Which explicit connections a sweep of a blade may cross: most are far from it, and
/// shaders/solver/tools/cut_links.comp need not be asked about them. Allocates nothing once it has looked.
class NearLinks {
 public:
  /// @param parallel  on which nodes are looked at; must outlive this
  explicit NearLinks(const Parallel& parallel) : parallel_(parallel) {}
  /// Looks where nodes are around the sweep. @param slots  of nodes with explicit connections, the same at every call
  void find(CpuLattice& lattice, const std::vector<uint32_t>& slots, const layout::ToolMotion& motion);
  /// May a spring between two nodes cross the sweep? Two beyond the same side of the box around it have none of it
  /// between them.
  bool mayCross(uint32_t slot, uint32_t other) const { return (outside_[slot] & outside_[other]) == 0; }
  /// May one of two nodes be in an eraser's sweep?
  bool mayErase(uint32_t slot, uint32_t other) const { return outside_[slot] == 0 || outside_[other] == 0; }

 private:
  float fastest(const CpuLattice& lattice, const std::vector<uint32_t>& slots);

  const Parallel& parallel_;
  std::vector<float> reach_m_;    ///< [slots] how far from a node its tissue may be
  std::vector<float> fastest2_;   ///< [jobs] largest |v|^2 of its nodes [m2/s2]
  std::vector<uint8_t> outside_;  ///< [slots] sides of the box that a node is beyond, with its tissue, a bit each
};

}  // namespace viscera
