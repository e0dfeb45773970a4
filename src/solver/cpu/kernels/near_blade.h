// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "layout/surface_offsets.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "solver/cpu/state/parallel.h"
#include "viscera/layout/tool_motion.h"

namespace viscera {

/// Search for the nodes of a lattice that a sweep of a blade may take springs from. Most are far from it and are
/// skipped brick by brick, or by the SIMD kernels. Allocates nothing after the first call.
class NearBlade {
 public:
  /// @param reach_m  [slots] largest distance of a node's tissue from the node
  /// @param parallel  for the search; must outlive this
  NearBlade(const CpuLattice& lattice, std::vector<float> reach_m, const Parallel& parallel,
            const simd::Kernels& kernels);
  /// Finds the nodes near a sweep.
  /// @param particles  for an eraser: nodes within its radius of the sweep
  /// @param at_rest  no node is displaced
  void find(const CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, bool at_rest);
  /// Returns the bricks with a node, or a slot for one, within the sphere that the blade may cut in, ascending.
  const std::vector<uint32_t>& bricks() const { return near_; }
  /// Returns the nodes of a near brick that may lose a spring, a bit each.
  uint64_t nodes(uint32_t brick) const { return nodes_[brick]; }
  /// Keeps those of these nodes for which lose(slot) is 1 and not 0. Calls it in parallel.
  template <class Lose>
  void keep(const CpuLattice& lattice, const Lose& lose);
  /// Returns whether a spring between two nodes of near bricks may cross the sweep. If both are beyond the same side of
  /// the box around the sweep, it does not.
  bool mayCross(uint32_t slot, uint32_t other) const { return (outside_[slot] & outside_[other]) == 0; }

 private:
  static constexpr size_t kBricksPerJob = 16;
  void clear();
  template <class Visit>
  void forEachNear(const Visit& visit) const;
  void findBricks(const CpuLattice& lattice, const layout::ToolMotion& motion, bool at_rest);
  bool isNearAtRest(const CpuLattice& lattice, uint32_t brick) const;
  float farthestOffset(const layout::ToolMotion& motion) const;
  void placeBrick(uint32_t brick);
  uint64_t nodesThatMayLose(const layout::Brick& brick) const;
  bool mayCross(const layout::Brick& brick) const;

  const Parallel& parallel_;
  simd::BrickSweep find_positions_;
  simd::BrickSides find_sides_;
  simd::SweepJob job_{};
  std::vector<float> reach_m_;                   ///< [slots] largest distance of a node's tissue from the node [m]
  std::vector<float> farthest_m_;                ///< [bricks] largest of these [m]
  std::vector<simd::Sweep> sweeps_;              ///< [bodies]
  std::vector<simd::BrickPositions> positions_;  ///< [bricks]
  std::vector<uint32_t> near_;                   ///< near bricks, ascending
  std::vector<uint8_t> outside_;  ///< [slots] of near bricks: sides of the box, a bit each; 255 elsewhere
  std::vector<uint8_t> common_;   ///< [bricks] sides beyond which all positions of a near brick are; 255 elsewhere
  std::vector<uint64_t> nodes_;   ///< [bricks] nodes of near bricks that may lose a spring
};

/// Calls visit(brick) for all near bricks in parallel.
template <class Visit>
void NearBlade::forEachNear(const Visit& visit) const {
  parallel_((near_.size() + kBricksPerJob - 1) / kBricksPerJob, [&](size_t job) {
    const size_t end = std::min(near_.size(), (job + 1) * kBricksPerJob);
    for (size_t n = job * kBricksPerJob; n < end; ++n) visit(near_[n]);
  });
}

template <class Lose>
void NearBlade::keep(const CpuLattice& lattice, const Lose& lose) {
  forEachNear([&](uint32_t brick) {
    uint64_t kept = 0;
    for (uint32_t i = lattice.store.first_active[brick]; nodes_[brick] && i < lattice.store.first_active[brick + 1];
         ++i) {
      const uint32_t slot = lattice.store.active[i], position = slot % layout::kBrickSlots;
      if (nodes_[brick] >> position & 1) kept |= lose(slot) << position;
    }
    nodes_[brick] = kept;
  });
}

}  // namespace viscera
