// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/forces/cell_pass.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Kernels that remove the springs that the swept blade crosses, or all springs of the nodes near it.
/// Owner of shaders/solver/tools/cut.comp (implicit connections) and cut_links.comp (explicit ones).
class CutPass {
 public:
  explicit CutPass(const FeatureSet& features);
  /// Cuts springs.
  /// @param stylus  row of the bound tool motions
  /// @param particles  removes nodes instead of single springs
  /// @param spared  bodies that are not cut, a bit each
  void run(const LatticeBuffers& buffers, uint32_t stylus, bool particles, uint32_t spared = 0) const;

 private:
  struct Programs {
    gpu::Program springs, particles;
  };
  Programs compiled(const char* shader, std::vector<std::string> defines) const;
  void runOver(const gpu::Program& program, gpu::UniformName what, size_t count, uint32_t stylus,
               uint32_t spared) const;

  std::optional<Programs> lattice_, links_;
  std::optional<TornCellsPass> torn_cells_;
  uint32_t group_size_;
};

}  // namespace viscera
