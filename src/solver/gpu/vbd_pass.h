// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/colours.h"
#include "solver/gpu/implicit_substep.h"

namespace viscera {

/// Vertex block descent on implicit Euler (physics.md 2): colour by colour, every node goes to the minimum of the
/// incremental potential over its own increment, by one step with a 3x3 block. Every step descends. Owner of
/// shaders/solver/vbd.comp.
class VbdPass : public Stepper {
 public:
  /// @param iterations  sweeps over all colours per substep
  VbdPass(const FeatureSet& features, const LatticeBuffers& buffers, int iterations, const NodePairs* pairs = nullptr);
  void run(LatticeBuffers& buffers, const Substep& step) override;

 private:
  ImplicitSubstep implicit_;
  gpu::Program sweep_[2];                  ///< without and with tools
  gpu::Buffer<uint32_t> by_colour_;        ///< [active] slots
  std::vector<Coloured::Colour> colours_;  ///< in by_colour_
  int iterations_;
  uint32_t group_size_;
};

}  // namespace viscera
