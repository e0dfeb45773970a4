// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/coarse_level.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

namespace viscera::multigrid {

namespace {

constexpr size_t kRowsPerJob = 128;
constexpr size_t kReadBeyond = 16 - BlockMatrix::kNumbers;  // see BlockRows

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

CoarseLevel::CoarseLevel(BlockMatrix matrix) : matrix_(std::move(matrix)), multiply_(multiplyRows()) {
  matrix_.numbers.resize(matrix_.numbers.size() + kReadBeyond);
  inverse_.assign(BlockMatrix::kNumbers * nodes(), 0);
  for (uint32_t node = 0; node < nodes(); ++node) {
    const Eigen::Matrix3d inverse = matrix_.block(matrix_.entryOf(node, node)).inverse();
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        inverse_[BlockMatrix::kNumbers * node + static_cast<size_t>(4 * j + i)] = static_cast<float>(inverse(i, j));
  }
  for (Quads* each : {&right, &solution, &change}) each->assign(numbers(), 0);
}

void CoarseLevel::apply(const Parallel& parallel, const Quads& x, Quads& y, bool subtract) const {
  const BlockRows rows = {matrix_.starts.data(), matrix_.columns.data(), matrix_.numbers.data()};
  parallel((nodes() + kRowsPerJob - 1) / kRowsPerJob, [&](size_t job) {
    multiply_(rows, x.data(), y.data(), subtract, job * kRowsPerJob, std::min(nodes(), (job + 1) * kRowsPerJob));
  });
}

void CoarseLevel::smooth(const Quads& r, float a, float b, bool first, Quads& d, Quads& z) const {
  const Quad none = {};
  for (size_t node = 0; node < nodes(); ++node) {
    const Quad s = plusBlock(none, &inverse_[BlockMatrix::kNumbers * node], &r[4 * node]);
    const Quad next = (first ? none : a * quadAt(&d[4 * node])) + b * s;
    quadAt(&d[4 * node]) = next;
    quadAt(&z[4 * node]) = (first ? none : quadAt(&z[4 * node])) + next;
  }
}

}  // namespace viscera::multigrid
