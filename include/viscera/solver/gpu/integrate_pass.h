// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/gpu/program.h"
#include "viscera/solver/gpu/lattice_buffers.h"

namespace viscera {

/// What the kernels must know of; everything else is compiled out.
struct FeatureSet {
  bool dashpot = false;
  bool single_body = false;
  uint32_t group_size = layout::kGroupSize;

  std::vector<std::string> defines() const;
};

/// One leapfrog substep of every active node (physics.md 2). Owner of shaders/integrate.comp.
class IntegratePass {
 public:
  /// Compiles the kernel with and without tools. @throws GpuError with file, line and the driver's log
  explicit IntegratePass(const FeatureSet& features);

  struct Step {
    float dt_s;        ///< substep
    float kick_s;      ///< dt_s, or half of it in the very first substep
    Vector3f gravity;  ///< [m/s2]
    bool tools;        ///< probe or held nodes are about: the kernel that knows them is used
  };
  /// state -> other state; the caller swaps. buffers must be bound.
  void run(const LatticeBuffers& buffers, const Step& step) const;

 private:
  gpu::Program plain_, with_tools_;
  uint32_t group_size_;
};

}  // namespace viscera
