// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

/// Kernel that slows the nodes of the current state after a substep (solver/tissue/slowing.h).
/// Owner of shaders/solver/step/slow.comp.
class SlowPass {
 public:
  explicit SlowPass(const FeatureSet& features);
  void run(const LatticeBuffers& buffers, const Substep& step) const;

 private:
  gpu::Program slow_;
  uint32_t group_size_;
};

}  // namespace viscera
