// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "solver/gpu/forces/cell_pass.h"
#include "solver/gpu/steps/stepper.h"

namespace viscera {

/// Position Verlet with backward-difference drag on absolute float32 positions, as printed in VR05 and GW, with the
/// true spring constant: x+ = 2 x - x_prev + dt^2 (F/m + g - gamma (x - x_prev)/dt) (physics.md 2). It exists to show
/// the cost of that scheme; it has no dashpots.
/// Owner of shaders/solver/step/verlet_paper.comp.
class VerletPaperPass : public Stepper {
 public:
  VerletPaperPass(const FeatureSet& features, const LatticeBuffers& buffers);
  void run(LatticeBuffers& buffers, const Substep& step) override;
  void persist(Archive& archive) override;

 private:
  void rebuild(const LatticeBuffers& buffers, const Substep& step) const;

  gpu::Program plain_, with_tools_, rebuild_;
  std::optional<CellPass> cells_;
  gpu::Buffer<layout::vec4> positions_[2];  ///< [slots] m: x at current_, x_prev at the other, which x+ overwrites
  gpu::TexelView position_texels_[2];
  int current_ = 0;
  float last_dt_s_ = 0;
  uint32_t group_size_;
};

}  // namespace viscera
