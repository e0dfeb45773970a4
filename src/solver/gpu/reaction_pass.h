// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "gpu/program.h"
#include "solver/features.h"
#include "solver/gpu/lattice_buffers.h"

namespace viscera {

/// Sums the momentum that each stylus gave over a tick, in a fixed order. Owner of shaders/solver/sum_impulses.comp.
class ReactionPass {
 public:
  ReactionPass(const FeatureSet& features, size_t active_count);
  /// Leaves impulse, angular and touched in the stats; clears the impulses. @param tips  [styluses] tissue frame
  void run(const LatticeBuffers& buffers, const std::array<Vector3f, layout::kMaxStyluses>& tips) const;

 private:
  gpu::Program leaves_, fold_;
  gpu::Buffer<std::array<layout::vec4, 2 * layout::kMaxStyluses>> partials_;
  uint32_t group_size_;
};

}  // namespace viscera
