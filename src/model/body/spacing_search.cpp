// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/spacing_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"

namespace viscera {
namespace {

constexpr double kCloseEnough = 0.02, kTooFar = 0.25;
constexpr int kMostSearches = 24;
constexpr double kUsualFill = 0.3;  ///< typical share of its box that an organ fills

double relativeError(size_t nodes, int target) {
  return std::abs(static_cast<double>(nodes) / target - 1);
}

/// Spacings known to give too many and too few nodes. Counts jump as cells appear and vanish, so this is only a guide.
struct Bracket {
  double fine_m = 0, coarse_m = std::numeric_limits<double>::infinity();

  void learn(double spacing_m, size_t nodes, int target) {
    if (nodes > static_cast<size_t>(target)) {
      fine_m = std::max(fine_m, spacing_m);
    } else {
      coarse_m = std::min(coarse_m, spacing_m);
    }
  }

  /// Returns the spacing of the nodes' power law, or the middle of the bracket if that is outside it.
  double next(double spacing_m, double factor) const {
    const double guess = spacing_m * factor;
    const bool bounded = fine_m > 0 && std::isfinite(coarse_m);
    return bounded && (guess <= fine_m || guess >= coarse_m) ? std::sqrt(fine_m * coarse_m) : guess;
  }
};

/// Finds the spacing that gives a number of nodes.
/// @param root   root of the number of nodes that is inversely proportional to the spacing
/// @param make   (spacing_m) -> result at this spacing
/// @param count  number of nodes of a result
template <class Make, class Count>
auto toNodes(int target, double start_m, double largest_m, double (*root)(double), Make make, Count count) {
  double spacing_m = std::min(start_m, largest_m), best_m = 0;
  Bracket bracket;
  decltype(make(spacing_m)) best;
  size_t best_nodes = 0;
  for (int pass = 0; pass < kMostSearches; ++pass) {
    auto made = make(spacing_m);
    const size_t nodes = count(made);
    bracket.learn(spacing_m, nodes, target);
    if (best_nodes == 0 || relativeError(nodes, target) < relativeError(best_nodes, target)) {
      best_nodes = nodes;
      best_m = spacing_m;
      best = std::move(made);
    }
    if (relativeError(best_nodes, target) <= kCloseEnough) return best;
    spacing_m = std::min(bracket.next(spacing_m, root(static_cast<double>(nodes) / target)), largest_m);
  }
  if (relativeError(best_nodes, target) <= kTooFar) return best;
  TextOut out;
  out << "target_nodes " << target << " cannot be reached: the nearest possible number is " << best_nodes
      << " nodes, at spacing_m " << best_m;
  throw LatticeError(out.str());
}

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
  const double start_m = size_m.minCoeff() > 0 ? std::cbrt(kUsualFill * size_m.prod() / target_nodes)
                                               : size_m.maxCoeff() / std::cbrt(target_nodes);  // flat: fill() throws
  return toNodes(
      target_nodes, start_m, size_m.maxCoeff(), std::cbrt,
      [&](double spacing_m) { return tissue.fill(spacing_m, progress); },
      [](const Filling& filling) { return countNodes(filling.solid); });
}

TriangleMesh shellToNodes(const Tissue& tissue, int target_nodes) {
  const double size_m = tissue.bounds().sizes().maxCoeff();
  return toNodes(
      target_nodes, size_m / std::sqrt(target_nodes), size_m, std::sqrt,
      [&](double spacing_m) { return tissue.shell(spacing_m); },
      [](const TriangleMesh& mesh) { return mesh.positions_m.size(); });
}

Filling fill(const Tissue& tissue, const BodyConfig& config, const Progress& progress) {
  if (config.target_nodes > 0) return fillToNodes(tissue, config.target_nodes, progress);
  if (config.auto_spacing) return fillToNodes(tissue, kUnmeasuredNodes, progress);
  return tissue.fill(config.spacing_m, progress);
}

}  // namespace viscera
