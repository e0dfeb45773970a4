// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/spacing_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kCloseEnough = 0.02, kTooFar = 0.25;
constexpr int kMostPasses = 24;
constexpr double kUsualFill = 0.3;  ///< share of its box that an organ fills

double relativeError(size_t nodes, int target) {
  return std::abs(static_cast<double>(nodes) / target - 1);
}

/// Spacings known to give too many and too few nodes. Counts jump about as cells come and go, so that this is a guide.
struct Bracket {
  double fine_m = 0, coarse_m = std::numeric_limits<double>::infinity();

  void learn(double spacing_m, size_t nodes, int target) {
    if (nodes > static_cast<size_t>(target)) {
      fine_m = std::max(fine_m, spacing_m);
    } else {
      coarse_m = std::min(coarse_m, spacing_m);
    }
  }

  /// Nodes go roughly with 1/h^3; where that leads out of the bracket, its middle is taken.
  double next(double spacing_m, size_t nodes, int target) const {
    const double guess = spacing_m * std::cbrt(static_cast<double>(nodes) / target);
    const bool bounded = fine_m > 0 && std::isfinite(coarse_m);
    return bounded && (guess <= fine_m || guess >= coarse_m) ? std::sqrt(fine_m * coarse_m) : guess;
  }
};

}  // namespace

size_t countNodes(const Solid& solid) {
  const size_t row = static_cast<size_t>(solid.cells.x()) + 1, layer = row * (solid.cells.y() + 1);
  std::vector<bool> is_node(layer * (solid.cells.z() + 1), false);
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.labels[solid.index(x, y, z)] == 0) continue;
        const size_t corner = x + row * y + layer * z;
        for (int c = 0; c < 8; ++c) is_node[corner + (c & 1) + row * (c >> 1 & 1) + layer * (c >> 2)] = true;
      }
    }
  }
  return static_cast<size_t>(std::count(is_node.begin(), is_node.end(), true));
}

Filling fillToNodes(const Tissue& tissue, int target_nodes, const Progress& progress) {
  const Vector3d size_m = tissue.bounds().sizes();
  double spacing_m = std::min(std::cbrt(kUsualFill * size_m.prod() / target_nodes), size_m.maxCoeff());
  Bracket bracket;
  Filling best;
  size_t best_nodes = 0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Filling filling = tissue.fill(spacing_m, progress);
    const size_t nodes = countNodes(filling.solid);
    bracket.learn(spacing_m, nodes, target_nodes);
    if (best_nodes == 0 || relativeError(nodes, target_nodes) < relativeError(best_nodes, target_nodes)) {
      best_nodes = nodes;
      best = std::move(filling);
    }
    if (relativeError(best_nodes, target_nodes) <= kCloseEnough) return best;
    spacing_m = std::min(bracket.next(spacing_m, nodes, target_nodes), size_m.maxCoeff());
  }
  if (relativeError(best_nodes, target_nodes) <= kTooFar) return best;
  std::ostringstream out;
  out << "target_nodes " << target_nodes << " is out of reach: the nearest is " << best_nodes
      << " nodes, with spacing_m " << best.solid.spacing_m;
  throw LatticeError(out.str());
}

}  // namespace viscera
