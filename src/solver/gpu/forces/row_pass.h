// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// A kernel over the nodes of thin walls (physics.md 1, Thin walls). Owner of shaders/solver/tissue/rows.comp and
/// row_forces.comp. Exists only with feature walls.
class RowPass {
 public:
  /// Returns the pass that writes the second differences which cells read.
  /// @param awake  only for cells next to awake bricks, as listed
  static RowPass differences(const FeatureSet& features, bool awake);
  /// Returns the pass that gathers the forces of cells on these differences for the nodes.
  /// @param awake  likewise
  static RowPass forces(const FeatureSet& features, bool awake);
  void run(const LatticeBuffers& buffers) const;

 private:
  RowPass(const char* kernel, const FeatureSet& features, bool awake);

  gpu::Program program_;
  uint32_t group_size_;
};

}  // namespace viscera
