// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "math/aligned.h"
#include "solver/cpu/store/parallel.h"
#include "solver/multigrid/levels/block_matrix.h"
#include "solver/multigrid/levels/coarse_kernels.h"

namespace viscera::multigrid {

/// A vector per node of a coarse level: x, y, z and a zero each.
using Quads = AlignedVector<float>;

/// A coarse level: its matrix in blocks of 3x3, node by node, and what its smoother needs.
class CoarseLevel {
 public:
  explicit CoarseLevel(BlockMatrix matrix);

  size_t nodes() const { return matrix_.rows(); }
  size_t numbers() const { return 4 * nodes(); }
  /// y = A x; or y -= A x.
  void apply(const Parallel& parallel, const Quads& x, Quads& y, bool subtract = false) const;
  /// d = a d + b D^-1 r, z += d; both begin as 0 where `first`.
  void smooth(const Quads& r, float a, float b, bool first, Quads& d, Quads& z) const;
  const BlockMatrix& matrix() const { return matrix_; }
  /// Calls visit(row, column, block) for all blocks.
  template <class Visit>
  void forBlocks(const Visit& visit) const {
    for (uint32_t row = 0; row < nodes(); ++row) {
      for (uint32_t i = matrix_.starts[row]; i < matrix_.starts[row + 1]; ++i)
        visit(row, matrix_.columns[i], matrix_.block(i));
    }
  }

  /// Inverse of a node's own block: BlockMatrix::kNumbers.
  const float* inverseAt(size_t node) const { return &inverse_[BlockMatrix::kNumbers * node]; }

  float largest = 0;  ///< eigenvalue of D^-1 A, estimated from below and enlarged

  // Work space of a cycle.
  mutable Quads right, solution, change;

 private:
  BlockMatrix matrix_;
  MultiplyRows multiply_;
  AlignedVector<float> inverse_;  ///< [nodes] of its blocks, BlockMatrix::kNumbers each
};

}  // namespace viscera::multigrid
