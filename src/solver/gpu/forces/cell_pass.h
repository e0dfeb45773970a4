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

/// Computes what cells that obey a law do to their corners, for the integrators to gather (physics.md 1). Owner of
/// shaders/solver/tissue/cell_forces.comp. Exists only where some body has a law.
class CellPass {
 public:
  /// @param awake  of cells beside these bricks only; null: of all
  explicit CellPass(const FeatureSet& features, const AwakeBricks* awake = nullptr);
  /// Leaves the forces of every cell in buffers.cell_forces, and those of rows of nodes in thin walls.
  void run(const LatticeBuffers& buffers) const;

 private:
  void runCells(const LatticeBuffers& buffers) const;

  gpu::Program cells_;
  std::optional<RowPass> rows_, row_forces_;  ///< feature walls
  const AwakeBricks* awake_;
  uint32_t group_size_;
};

/// Marks cells that have lost a spring: they are no longer whole. Owner of shaders/solver/tissue/cell_forces.comp
/// (feature CUT).
class TornCellsPass {
 public:
  explicit TornCellsPass(const FeatureSet& features);
  void run(const LatticeBuffers& buffers) const;

 private:
  gpu::Program torn_;
  uint32_t group_size_;
};

}  // namespace viscera
