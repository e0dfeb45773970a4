// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Kernel that sums the momentum that each stylus, or each obstacle, gave in a tick, in a fixed order.
/// Owner of shaders/solver/step/sum_impulses.comp.
class ReactionPass {
 public:
  /// @param obstacles  for obstacles instead of styluses
  ReactionPass(const FeatureSet& features, size_t active_count, bool obstacles = false);
  /// Writes impulse, angular and touched into the stats, and clears the impulses.
  /// @param tips  [styluses] tissue frame [m]
  void run(const LatticeBuffers& buffers, const std::array<Vector3f, layout::kMaxStyluses>& tips) const {
    sum(buffers, tips, 0);
  }

  /// Writes obstacle_impulse and obstacle_angular into the stats.
  /// @param places  [obstacles] positions, tissue frame [m]
  void runObstacles(const LatticeBuffers& buffers, const std::vector<Vector3f>& positions) const;

 private:
  using Positions = std::array<Vector3f, layout::kMaxStyluses>;
  void sum(const LatticeBuffers& buffers, const Positions& positions, uint32_t giver) const;
  gpu::Program leaves_, fold_;
  gpu::Buffer<std::array<layout::vec4, 2 * layout::kMaxStyluses>> partials_;
  uint32_t group_size_;
};

}  // namespace viscera
