// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "viscera/solver/governor.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Puts a good state in the place of a bad one before anybody sees it, without asking the host: the governor, which
/// judges a tick later, then only says how to go on (physics.md 3). Owner of shaders/solver/step/guard.comp.
class GuardPass {
 public:
  explicit GuardPass(const FeatureSet& features);
  /// Reads the stats and GoodStates::bindLast(). @param motions  of the tick   @param tick_s  its length
  void run(const LatticeBuffers& buffers, const Governor::Bounds& bounds, const ToolMotions& motions,
           double tick_s) const;

 private:
  gpu::Program guard_;
  uint32_t group_size_;
};

}  // namespace viscera
