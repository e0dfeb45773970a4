// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "solver/gpu/buffers/awake_bricks.h"
#include "solver/gpu/contact/edges_pass.h"
#include "solver/gpu/forces/cell_pass.h"
#include "solver/gpu/steps/stepper.h"

namespace viscera {

/// Leapfrog on (u, v) with symmetric drag (physics.md 2). Owner of shaders/solver/step/leapfrog.comp.
class LeapfrogPass : public Stepper {
 public:
  /// Compiles the kernel, and one with tools if there are any.
  /// @param awake  steps and reports only these bricks; null: steps all. Must outlive the pass
  explicit LeapfrogPass(const FeatureSet& features, AwakeBricks* awake = nullptr);
  void run(LatticeBuffers& buffers, const Substep& step) override;

 private:
  gpu::Program plain_, with_tools_;
  std::optional<EdgesPass> edges_;
  std::optional<CellPass> cells_;
  AwakeBricks* awake_;
  uint32_t group_size_;
};

}  // namespace viscera
