// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "solver/multigrid/levels/hierarchy.h"
#include "solver/tissue/features.h"
#include "viscera/layout/types.h"

namespace viscera {

/// Kernels of the levels below the lattice. Owner of shaders/solver/multigrid/multigrid_coarse.comp.
struct MultigridCoarseKernels {
  explicit MultigridCoarseKernels(const FeatureSet& features, bool held);
  gpu::Program product, solve, smooth, restrict_fine, restrict_coarse, prolong_fine, prolong_coarse;
  uint32_t group_size;
};

/// A multigrid::Hierarchy on the GPU: the levels below the lattice and the ways between them.
class MultigridLevels {
 public:
  /// @param slots  [nodes] of the hierarchy's finest level
  explicit MultigridLevels(const multigrid::Hierarchy& hierarchy, const std::vector<uint32_t>& slots);

  bool empty() const { return levels_.empty(); }
  /// Adds to the correction what coarse levels make of the residual in kSystemWork, and leaves it as the change.
  /// @param slots  of the lattice
  void correct(const MultigridCoarseKernels& kernels, size_t nodes, size_t slots) const;

 private:
  /// Where numbers of a level begin in the arrays.
  struct Level {
    uint32_t nodes;
    uint32_t right, solution, change;  ///< vectors
    uint32_t blocks, inverse;          ///< columns
    uint32_t starts, columns;          ///< words
    float largest;
    struct Way {
      uint32_t starts, entries, weights;  ///< words
    } down, up;                           ///< from and to the level above
  };
  Level::Way addWay(const std::vector<uint32_t>& starts, std::vector<uint32_t> entries,
                    const std::vector<float>& weights, const std::vector<uint32_t>* slots);
  uint32_t addWords(const std::vector<uint32_t>& words);
  void addLevel(const multigrid::CoarseLevel& level);
  void addCoarsest(const multigrid::Hierarchy& hierarchy);
  void run(const gpu::Program& program, size_t nodes, uint32_t group_size) const;
  void tell(const gpu::Program& program, const Level::Way& way) const;
  void smooth(const MultigridCoarseKernels& kernels, const Level& level, float a, float b, bool first) const;
  void subtractProduct(const MultigridCoarseKernels& kernels, const Level& level) const;
  void smoothTwice(const MultigridCoarseKernels& kernels, const Level& level, bool first) const;
  void solveCoarsest(const MultigridCoarseKernels& kernels) const;
  void cycle(const MultigridCoarseKernels& kernels, size_t index) const;

  std::vector<Level> levels_;
  bool direct_ = false;   ///< the coarsest one's inverse is known
  uint32_t inverse_ = 0;  ///< where it begins, columns
  std::vector<uint32_t> words_;
  std::vector<layout::vec4> columns_;
  gpu::Buffer<layout::vec4> vectors_, matrices_;
  gpu::Buffer<uint32_t> graph_;
};

}  // namespace viscera
