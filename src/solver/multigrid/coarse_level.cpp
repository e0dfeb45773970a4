// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/coarse_level.h"

#include <Eigen/LU>
#include <algorithm>

namespace viscera::multigrid {

namespace {

constexpr size_t kRowsPerJob = 128;

/// Four floats as the compiler's vectors.
using Quad = float __attribute__((vector_size(16)));

inline Quad quadAt(const float* at) {
  return *reinterpret_cast<const Quad*>(at);
}
inline Quad& quadAt(float* at) {
  return *reinterpret_cast<Quad*>(at);
}

/// sum + B x, B as three columns.
inline Quad plusBlock(Quad sum, const float* block, const float* x) {
  return sum + quadAt(block) * x[0] + quadAt(block + 4) * x[1] + quadAt(block + 8) * x[2];
}

}  // namespace

CoarseLevel::CoarseLevel(const Elements& elements) {
  const size_t count = elements.node_at.size();
  std::vector<std::vector<uint32_t>> beside(count);
  for (const Element& element : elements.elements) {
    for (const int32_t a : element.nodes) {
      for (const int32_t b : element.nodes) {
        if (a >= 0 && b >= 0) beside[static_cast<size_t>(a)].push_back(static_cast<uint32_t>(b));
      }
    }
  }
  starts_.push_back(0);
  for (std::vector<uint32_t>& row : beside) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    starts_.push_back(static_cast<uint32_t>(columns_.size()));
  }
  blocks_.assign(kBlockNumbers * columns_.size(), 0);
  for (const Element& element : elements.elements) addElement(element, elements.matrices[element.matrix]);
  invertDiagonal();
  for (Quads* each : {&right, &solution, &change}) each->assign(numbers(), 0);
}

void CoarseLevel::addElement(const Element& element, const ElementMatrix& matrix) {
  for (int a = 0; a < 8; ++a) {
    const int32_t row = element.nodes[static_cast<size_t>(a)];
    if (row < 0) continue;
    const auto first = columns_.begin() + starts_[static_cast<size_t>(row)];
    const auto end = columns_.begin() + starts_[static_cast<size_t>(row) + 1];
    for (int b = 0; b < 8; ++b) {
      const int32_t column = element.nodes[static_cast<size_t>(b)];
      if (column < 0) continue;
      const auto entry =
          static_cast<size_t>(std::lower_bound(first, end, static_cast<uint32_t>(column)) - columns_.begin());
      float* to = &blocks_[kBlockNumbers * entry];
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) to[4 * j + i] += matrix(3 * a + i, 3 * b + j);
    }
  }
}

Eigen::Matrix3d CoarseLevel::blockAt(size_t entry) const {
  Eigen::Matrix3d out;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      out(i, j) = static_cast<double>(blocks_[kBlockNumbers * entry + static_cast<size_t>(4 * j + i)]);
  return out;
}

Eigen::Matrix3d CoarseLevel::block(uint32_t row, uint32_t column) const {
  const auto first = columns_.begin() + starts_[row], end = columns_.begin() + starts_[row + 1];
  const auto at = std::lower_bound(first, end, column);
  return at != end && *at == column ? blockAt(static_cast<size_t>(at - columns_.begin())) : Eigen::Matrix3d::Zero();
}

void CoarseLevel::invertDiagonal() {
  inverse_.assign(kBlockNumbers * nodes(), 0);
  for (uint32_t node = 0; node < nodes(); ++node) {
    const Eigen::Matrix3d inverse = block(node, node).inverse();
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        inverse_[kBlockNumbers * node + static_cast<size_t>(4 * j + i)] = static_cast<float>(inverse(i, j));
  }
}

void CoarseLevel::apply(const Parallel& parallel, const Quads& x, Quads& y, bool subtract) const {
  parallel((nodes() + kRowsPerJob - 1) / kRowsPerJob, [&](size_t job) {
    for (size_t row = job * kRowsPerJob; row < std::min(nodes(), (job + 1) * kRowsPerJob); ++row) {
      Quad sum = {};
      for (size_t i = starts_[row]; i < starts_[row + 1]; ++i)
        sum = plusBlock(sum, &blocks_[kBlockNumbers * i], &x[4 * size_t{columns_[i]}]);
      quadAt(&y[4 * row]) = subtract ? quadAt(&y[4 * row]) - sum : sum;
    }
  });
}

void CoarseLevel::smooth(const Quads& r, float a, float b, bool first, Quads& d, Quads& z) const {
  const Quad none = {};
  for (size_t node = 0; node < nodes(); ++node) {
    const Quad s = plusBlock(none, &inverse_[kBlockNumbers * node], &r[4 * node]);
    const Quad next = (first ? none : a * quadAt(&d[4 * node])) + b * s;
    quadAt(&d[4 * node]) = next;
    quadAt(&z[4 * node]) = (first ? none : quadAt(&z[4 * node])) + next;
  }
}

}  // namespace viscera::multigrid
