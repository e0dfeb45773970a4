// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "math/aligned.h"

namespace viscera::multigrid {

/// A symmetric matrix in blocks of 3x3, by rows of nodes.
struct BlockMatrix {
  static constexpr size_t kNumbers = 12;  ///< of a block: three columns of x, y, z and a zero

  std::vector<uint32_t> starts{0};  ///< [rows + 1]
  std::vector<uint32_t> columns;    ///< [entries] ascending in a row
  AlignedVector<float> numbers;     ///< [entries] kNumbers each

  size_t rows() const { return starts.size() - 1; }
  float* at(size_t entry) { return &numbers[kNumbers * entry]; }
  const float* at(size_t entry) const { return &numbers[kNumbers * entry]; }
  /// Entry of a row's column; columns.size() where it has none.
  size_t entryOf(uint32_t row, uint32_t column) const {
    const auto first = columns.begin() + starts[row], end = columns.begin() + starts[row + 1];
    const auto found = std::lower_bound(first, end, column);
    return found != end && *found == column ? static_cast<size_t>(found - columns.begin()) : columns.size();
  }
  bool isZero(size_t entry) const {
    return std::all_of(at(entry), at(entry) + kNumbers, [](float each) { return each == 0; });
  }
  Eigen::Matrix3d block(size_t entry) const {
    Eigen::Matrix3d out;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) out(i, j) = static_cast<double>(at(entry)[4 * j + i]);
    return out;
  }
};

}  // namespace viscera::multigrid
