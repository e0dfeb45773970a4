// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/solver/gpu/integrate_pass.h"

namespace viscera {

/// Non-finite nodes, largest stretch and speed, held nodes, once a tick. Owner of shaders/measure.comp.
class MeasurePass {
 public:
  explicit MeasurePass(const FeatureSet& features);
  /// Clears what belongs to one tick (all but springs_cut), then measures the current state.
  void run(const LatticeBuffers& buffers) const;

 private:
  gpu::Program measure_;
  uint32_t group_size_;
};

}  // namespace viscera
