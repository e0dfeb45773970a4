// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/hierarchy.h"

#include <cmath>

namespace viscera::multigrid {

namespace {

constexpr size_t kFewNodes = 27;      // are solved for directly
constexpr double kShrinks = 0.8;      // a level with more of the nodes above is not worth having
constexpr int kPowerIterations = 12;  // come within some percent of the largest eigenvalue
constexpr float kEnlarged = 1.1f;     // for what they miss, and for what motion adds
constexpr float kSmoothed = 6;        // largest eigenvalue over the smallest that is the smoother's affair
constexpr float kBeside = 2.5f;       // over the largest eigenvalue: a smoother's step beside coarse levels

/// A start for power iterations that has something of every mode, the same every time.
float somethingAt(size_t i) {
  return static_cast<float>((i * 2654435761u >> 8) % 1024) / 512.0f - 1;
}

float largestOfCoarse(const CoarseLevel& level, const Parallel& parallel) {
  Quads x(level.numbers()), y(level.numbers()), d(level.numbers());
  for (size_t i = 0; i < x.size(); ++i) x[i] = i % 4 == 3 ? 0 : somethingAt(i);
  float grown = 1;
  for (int k = 0; k < kPowerIterations; ++k) {
    level.apply(parallel, x, y);
    level.smooth(y, 0, 1, true, d, x);
    double sum = 0;
    for (const float each : x) sum += static_cast<double>(each * each);
    grown = static_cast<float>(std::sqrt(sum));
    for (float& each : x) each /= std::max(grown, 1e-30f);
  }
  return kEnlarged * grown;
}

/// Sums of what nodes of one level have at nodes of another. @param starts, others, weights  where each one's begin,
/// and they
void gather(const std::vector<uint32_t>& starts, const std::vector<uint32_t>& others, const std::vector<float>& weights,
            const Quads& from, Quads& to) {
  for (size_t node = 0; node + 1 < starts.size(); ++node) {
    float sum[3] = {};
    for (uint32_t i = starts[node]; i < starts[node + 1]; ++i) {
      for (size_t c = 0; c < 3; ++c) sum[c] += weights[i] * from[4 * size_t{others[i]} + c];
    }
    for (size_t c = 0; c < 3; ++c) to[4 * node + c] = sum[c];
  }
}

void restrictTo(const Transfer& t, const Quads& fine, Quads& coarse) {
  gather(t.coarse_starts, t.children, t.coarse_weights, fine, coarse);
}

void interpolate(const Transfer& t, const Quads& coarse, Quads& fine) {
  gather(t.starts, t.parents, t.weights, coarse, fine);
}

}  // namespace

float largestOf(const FineLevel& level) {
  Vectors x(3 * level.places()), y(x.size()), d(x.size());
  for (const uint32_t place : level.grid().place_of) {
    for (size_t c = 0; c < 3; ++c) x[c * level.places() + place] = level.free()[place] * somethingAt(3 * place + c);
  }
  float grown = 1;
  for (int k = 0; k < kPowerIterations; ++k) {
    level.apply(x, y);
    level.precondition(y, 1, d, x);
    grown = static_cast<float>(std::sqrt(level.dot(x, x)));
    for (float& each : x) each /= std::max(grown, 1e-30f);
  }
  return kEnlarged * grown;
}

Chebyshev::Chebyshev(float largest) {
  const float smallest = largest / kSmoothed, middle = (largest + smallest) / 2, half = (largest - smallest) / 2;
  first = 1 / middle;
  const float sigma = middle / half, rho = 1 / (2 * sigma - 1 / sigma);
  again = rho / sigma;
  second = 2 * rho / half;
}

Hierarchy::Hierarchy(const FineLevel& level, const Parallel& parallel) : parallel_(parallel) {
  LevelNodes nodes;
  size_t above = 0;
  Coarsening next;
  {
    const Elements lattice = elementsOf(level);
    elements_ = lattice.elements.size();
    above = lattice.nodes.at.size();
    next = coarsened(lattice);
  }
  for (;;) {
    const size_t count = next.nodes.at.size();
    if (count == 0 || (!levels_.empty() && static_cast<double>(count) > kShrinks * static_cast<double>(above))) break;
    levels_.push_back(std::make_unique<CoarseLevel>(std::move(next.matrix)));
    levels_.back()->largest = largestOfCoarse(*levels_.back(), level.parallel());
    transfers_.push_back(std::move(next.transfer));
    nodes = std::move(next.nodes);
    above = count;
    if (count <= kFewNodes) break;
    next = coarsened(nodes, levels_.back()->matrix());
  }
  if (levels_.empty()) return;
  std::vector<Eigen::Triplet<double>> entries;
  levels_.back()->forBlocks([&](uint32_t row, uint32_t column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        entries.emplace_back(3 * row + static_cast<uint32_t>(i), 3 * column + static_cast<uint32_t>(j), block(i, j));
  });
  const auto size = static_cast<Eigen::Index>(3 * levels_.back()->nodes());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  coarsest_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(matrix);
}

Eigen::MatrixXd Hierarchy::coarsestInverse() const {
  return coarsest_->solve(Eigen::MatrixXd::Identity(coarsest_->rows(), coarsest_->rows()));
}

void Hierarchy::restrictFine(const FineLevel& level, const Vectors& r) const {
  const Transfer& t = transfers_[0];
  const size_t n = level.places();
  const std::vector<uint32_t>& place_of = level.grid().place_of;
  constexpr size_t kPerJob = 256;
  Quads& to = levels_[0]->right;
  parallel_((levels_[0]->nodes() + kPerJob - 1) / kPerJob, [&](size_t job) {
    for (size_t node = job * kPerJob; node < std::min(levels_[0]->nodes(), (job + 1) * kPerJob); ++node) {
      float sum[3] = {};
      for (uint32_t i = t.coarse_starts[node]; i < t.coarse_starts[node + 1]; ++i) {
        const size_t place = place_of[t.children[i]];
        for (size_t c = 0; c < 3; ++c) sum[c] += t.coarse_weights[i] * r[c * n + place];
      }
      for (size_t c = 0; c < 3; ++c) to[4 * node + c] = sum[c];
    }
  });
}

/// The solution of the first coarse level, at the nodes of the finest.
void Hierarchy::addToFine(const FineLevel& level, Vectors& correction) const {
  const Transfer& t = transfers_[0];
  const size_t n = level.places();
  const Grid& grid = level.grid();
  constexpr size_t kPerJob = 1024;
  const Quads& from = levels_[0]->solution;
  parallel_((grid.nodeCount() + kPerJob - 1) / kPerJob, [&](size_t job) {
    for (size_t node = job * kPerJob; node < std::min(grid.nodeCount(), (job + 1) * kPerJob); ++node) {
      const size_t place = grid.place_of[node];
      float sum[3] = {};
      for (uint32_t i = t.starts[node]; i < t.starts[node + 1]; ++i) {
        for (size_t c = 0; c < 3; ++c) sum[c] += t.weights[i] * from[4 * size_t{t.parents[i]} + c];
      }
      for (size_t c = 0; c < 3; ++c) correction[c * n + place] = level.free()[place] * sum[c];
    }
  });
}

void Hierarchy::solveCoarsest() const {
  const CoarseLevel& level = *levels_.back();
  Eigen::VectorXd right(3 * static_cast<Eigen::Index>(level.nodes()));
  for (size_t node = 0; node < level.nodes(); ++node) {
    for (size_t c = 0; c < 3; ++c)
      right[static_cast<Eigen::Index>(3 * node + c)] = static_cast<double>(level.right[4 * node + c]);
  }
  const Eigen::VectorXd solution = coarsest_->solve(right);
  for (size_t node = 0; node < level.nodes(); ++node) {
    for (size_t c = 0; c < 3; ++c)
      level.solution[4 * node + c] = static_cast<float>(solution[static_cast<Eigen::Index>(3 * node + c)]);
  }
}

/// Solution of a coarse level for its right side, which is overwritten.
void Hierarchy::cycleAt(size_t index) const {
  if (index + 1 == levels_.size()) return solveCoarsest();
  const CoarseLevel &level = *levels_[index], &below = *levels_[index + 1];
  const Chebyshev cheb(level.largest);
  Quads &r = level.right, &z = level.solution, &d = level.change;
  level.smooth(r, 0, cheb.first, true, d, z);
  level.apply(parallel_, d, r, true);
  level.smooth(r, cheb.again, cheb.second, false, d, z);
  level.apply(parallel_, d, r, true);
  restrictTo(transfers_[index + 1], r, below.right);
  cycleAt(index + 1);
  interpolate(transfers_[index + 1], below.solution, d);
  for (size_t i = 0; i < z.size(); ++i) z[i] += d[i];
  level.apply(parallel_, d, r, true);
  level.smooth(r, 0, cheb.first, false, d, z);
  level.apply(parallel_, d, r, true);
  level.smooth(r, cheb.again, cheb.second, false, d, z);
}

double Hierarchy::cycle(const FineLevel& level, float largest, const Vectors& r, Work& work, Vectors& z) const {
  const Chebyshev cheb(largest);
  level.precondition(r, cheb.first, work.r, work.d);
  level.smoothFresh(work.d, cheb.again, cheb.second, work.r, work.e, z);
  if (levels_.empty()) return level.dot(r, z);
  level.apply(work.e, work.r, true);
  restrictFine(level, work.r);
  cycleAt(0);
  addToFine(level, work.d);
  level.project(work.d);
  level.smooth(work.d, 0, cheb.first, 1, work.r, work.e, z);
  return level.smooth(work.e, cheb.again, cheb.second, 0, work.r, work.d, z, &r);
}

double Hierarchy::cycleSideBySide(const FineLevel& level, float largest, const Vectors& r, Work& work,
                                  Vectors& z) const {
  level.precondition(r, kBeside / largest, work.r, z);
  if (!levels_.empty()) {
    restrictFine(level, r);
    cycleAt(0);
    addToFine(level, work.d);
    level.project(work.d);
    level.turn(1, work.d, z);
  }
  return level.dot(r, z);
}

}  // namespace viscera::multigrid
