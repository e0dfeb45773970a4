// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "gpu/program.h"
#include "solver/gpu/buffers/awake_bricks.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/forces/row_pass.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Kernel that computes the forces of cells with a law on their corners, which the integrators gather (physics.md 1).
/// Owner of shaders/solver/tissue/cell_forces.comp. Exists only if some body has a law.
class CellPass {
 public:
  /// @param awake  only for cells next to these bricks; null: for all
  explicit CellPass(const FeatureSet& features, const AwakeBricks* awake = nullptr);
  /// Writes the forces of every cell into buffers.cell_forces, including those of rows of nodes in thin walls.
  void run(const LatticeBuffers& buffers) const;

 private:
  void runCells(const LatticeBuffers& buffers) const;

  gpu::Program cells_;
  std::optional<RowPass> rows_, row_forces_;  ///< feature walls
  const AwakeBricks* awake_;
  uint32_t group_size_;
};

/// Kernel that marks cells that have lost a spring. Owner of shaders/solver/tissue/cell_forces.comp (feature CUT).
class TornCellsPass {
 public:
  explicit TornCellsPass(const FeatureSet& features);
  void run(const LatticeBuffers& buffers) const;

 private:
  gpu::Program torn_;
  uint32_t group_size_;
};

}  // namespace viscera
