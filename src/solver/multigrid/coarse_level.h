// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "math/aligned.h"
#include "solver/cpu/parallel.h"
#include "solver/multigrid/elements.h"

namespace viscera::multigrid {

/// A vector per node of a coarse level: x, y, z and a zero each.
using Quads = AlignedVector<float>;

/// A coarse level: its matrix in blocks of 3x3, node by node, and what its smoother needs.
class CoarseLevel {
 public:
  explicit CoarseLevel(const Elements& elements);

  size_t nodes() const { return starts_.size() - 1; }
  size_t numbers() const { return 4 * nodes(); }
  /// y = A x; or y -= A x.
  void apply(const Parallel& parallel, const Quads& x, Quads& y, bool subtract = false) const;
  /// d = a d + b D^-1 r, z += d; both begin as 0 where `first`.
  void smooth(const Quads& r, float a, float b, bool first, Quads& d, Quads& z) const;
  /// Block of two nodes, row by row; zero where they are no neighbours.
  Eigen::Matrix3d block(uint32_t row, uint32_t column) const;
  /// Calls visit(row, column, block) for all blocks.
  template <class Visit>
  void forBlocks(const Visit& visit) const {
    for (uint32_t row = 0; row < nodes(); ++row) {
      for (uint32_t i = starts_[row]; i < starts_[row + 1]; ++i) visit(row, columns_[i], blockAt(i));
    }
  }

  float largest = 0;  ///< eigenvalue of D^-1 A, estimated from below and enlarged

  // Work space of a cycle.
  mutable Quads right, solution, change;

 private:
  static constexpr size_t kBlockNumbers = 12;  // three columns of x, y, z and a zero
  Eigen::Matrix3d blockAt(size_t entry) const;
  void addElement(const Element& element, const ElementMatrix& matrix);
  void invertDiagonal();

  std::vector<uint32_t> starts_, columns_;
  AlignedVector<float> blocks_, inverse_;  ///< [entries, nodes] kBlockNumbers each
};

}  // namespace viscera::multigrid
