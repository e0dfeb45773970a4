// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/forces/row_pass.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Kernel that measures, once per tick: non-finite nodes, largest stretch and speed, energies, held nodes.
/// Owner of shaders/solver/step/measure.comp.
class MeasurePass {
 public:
  MeasurePass(const FeatureSet& features, size_t active_count);
  /// Clears the values of one tick (all but springs_cut), then measures the current state.
  void run(const LatticeBuffers& buffers) const;

 private:
  void sumEnergies(const LatticeBuffers& buffers) const;

  gpu::Program measure_, fold_;
  std::optional<RowPass> rows_;                 ///< feature walls
  gpu::Buffer<std::array<float, 2>> energies_;  ///< of nodes, then of the runs of each level
  uint32_t group_size_;
};

}  // namespace viscera
