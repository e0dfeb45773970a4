// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "viscera/solver/stability_monitor.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Kernel that replaces a bad state by a good one on the GPU before anything reads it. The stability monitor, which
/// judges a tick later, then only decides how to continue (physics.md 3).
/// Owner of shaders/solver/step/guard.comp.
class GuardPass {
 public:
  explicit GuardPass(const FeatureSet& features);
  /// Reads the stats and GoodStates::bindLast(), and replaces the state if it exceeds the bounds.
  /// @param motions  of the tick
  /// @param tick_s  its length
  void run(const LatticeBuffers& buffers, const StabilityMonitor::Bounds& bounds, const ToolMotions& motions,
           double tick_s) const;

 private:
  gpu::Program guard_;
  uint32_t group_size_;
  bool shafts_;
};

}  // namespace viscera
