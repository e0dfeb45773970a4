// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Edge-centric forces of explicit connections (GW 4.2), for leapfrog to sum. Owner of
/// shaders/solver/tissue/spring_forces.comp. Exists only where a scene asks for solver.spring_forces: edge.
class SpringForcePass {
 public:
  explicit SpringForcePass(const FeatureSet& features);
  /// Leaves in buffers.links.link_forces what the springs do to each node, in parts (EdgeForces).
  void run(const LatticeBuffers& buffers) const;

 private:
  gpu::Program forces_;
  uint32_t group_size_;
};

}  // namespace viscera
