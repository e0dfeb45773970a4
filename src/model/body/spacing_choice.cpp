// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/spacing_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kAim = 0.98;         ///< target load: node counts jump as cells appear and vanish
constexpr double kNearEnough = 0.93;  ///< load that ends the search: 1.3 % of the spacing below the target
constexpr double kFewestNodes = 500;  ///< coarser lattices are too coarse to be tissue: the spacing means nothing then
constexpr double kNearFewest = 1.2 * kFewestNodes;
constexpr int kMostPasses = 12;
constexpr double kBack = 1.05;  ///< step towards coarser spacings after a trial that failed

/// Returns the nearest number of three digits that is not smaller.
double roundedUp(double value) {
  constexpr double kNoise = 1e-9;
  const double units = std::pow(10.0, 2 - std::floor(std::log10(value)));
  return std::ceil(value * units - kNoise) / units;
}

/// Returns the smallest integer fraction of an edge that is not smaller than a spacing; the whole edge if it is
/// shorter.
double wholePart(double edge_m, double spacing_m) {
  constexpr double kNoise = 1e-9;
  return edge_m / std::max(1.0, std::floor(edge_m / spacing_m + kNoise));
}

/// Number of nodes as a power of the spacing, exact at the last count.
struct NodeLaw {
  double spacing_m, nodes, power;
  double at(double h) const { return nodes * std::pow(spacing_m / h, power); }
  double spacingOf(double wanted) const { return spacing_m * std::pow(nodes / wanted, 1 / power); }
};

class Search {
 public:
  Search(const std::function<size_t(double)>& nodes, const SpacingLimits& limits)
      : count_(nodes), limits_(limits), finest_m_(limits.finest_m) {}

  /// Initialises the law from two counts. The finer one may not fit in memory.
  void begin(double start_m) {
    const double coarse = static_cast<double>(count_(start_m));
    law_ = {start_m, coarse, 3};
    last_ = choice(start_m, coarse, SpacingBound::kTooSlow);
    if (const std::optional<double> fine = tryCount(start_m / 2)) {
      law_ = {start_m / 2, *fine, std::clamp(std::log2(*fine / coarse), 1.0, 3.5)};
    }
  }

  SpacingChoice run(const Progress& progress) {
    std::set<double> tried;
    double step_back = 1;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      if (progress) progress("choose spacing", static_cast<double>(pass) / kMostPasses);
      const double h = admissible(predicted() * step_back);
      if (!tried.insert(h).second) {
        if (best_ || isCoarsest(h)) break;
        step_back *= kBack;
        continue;
      }
      const std::optional<double> nodes = tryCount(h);
      if (!nodes) continue;
      law_.spacing_m = h;
      law_.nodes = *nodes;
      record(h, *nodes);
      if (best_ && best_->spacing_m == h && (best_->load >= kNearEnough || atItsFinest(h, *nodes))) break;
      if (!best_ && *nodes < kNearFewest) break;
    }
    if (progress) progress("choose spacing", 1);
    if (!best_ && isCoarsest(last_->spacing_m)) last_->bound = SpacingBound::kWalls;
    return best_ ? *best_ : *last_;
  }

 private:
  /// Returns nothing if the lattice does not fit in memory, or no cell is in the body: the search then avoids it.
  std::optional<double> tryCount(double h) {
    try {
      return static_cast<double>(count_(h));
    } catch (const LatticeError&) {
      if (h > law_.spacing_m) {
        empty_m_ = h;
      } else {
        finest_m_ = std::max(h * kBack, std::sqrt(h * law_.spacing_m));  // half way to what fits
        memory_ = true;
      }
      return std::nullopt;
    }
  }

  /// Returns the nearest spacing that is not finer, unless walls require a finer one.
  double admissible(double h) const {
    constexpr double kNoise = 1e-9;
    const double whole_m = limits_.whole_m, coarsest_m = limits_.coarsest_m;
    const double rounded_m = whole_m > 0 ? wholePart(whole_m, h) : roundedUp(h);
    if (!(rounded_m > coarsest_m)) return rounded_m;  // NaN for a finest spacing of 0
    return whole_m > 0 ? whole_m / std::ceil(whole_m / coarsest_m - kNoise) : coarsest_m;
  }
  bool isCoarsest(double h) const { return std::isfinite(limits_.coarsest_m) && h >= admissible(limits_.coarsest_m); }
  double load(double h, double nodes) const {
    return limits_.substeps_per_s(h) * limits_.step.of(nodes + static_cast<double>(limits_.other_nodes)) /
           limits_.stepping_share;
  }
  bool tooMany(double nodes) const {
    return nodes + static_cast<double>(limits_.other_nodes) > static_cast<double>(limits_.most_nodes);
  }
  double coarsest_m() const {
    return std::min({law_.spacingOf(std::min(kFewestNodes, law_.nodes)), empty_m_ / kBack, limits_.coarsest_m});
  }

  /// Returns the finest spacing that the law predicts to be admissible.
  double predicted() const {
    const auto holds = [this](double h) { return load(h, law_.at(h)) <= kAim && !tooMany(law_.at(h) / kAim); };
    double fine = std::max(finest_m_, law_.spacing_m * 1e-3), coarse = std::max(coarsest_m(), fine);
    if (holds(fine)) return fine;
    while (coarse / fine > 1 + 1e-4) {
      const double middle = std::sqrt(fine * coarse);
      (holds(middle) ? coarse : fine) = middle;
    }
    return coarse;
  }

  SpacingChoice choice(double h, double nodes, SpacingBound bound) const {
    return {h, static_cast<size_t>(nodes) + limits_.other_nodes, limits_.substeps_per_s(h), load(h, nodes), bound};
  }

  /// Records a trial as the best so far if it keeps to the limits and no finer one does.
  void record(double h, double nodes) {
    last_ = choice(h, nodes, SpacingBound::kTooSlow);
    if (load(h, nodes) > 1 || tooMany(nodes) || h < limits_.finest_m) return;
    if (best_ && best_->spacing_m <= h) return;
    best_ = choice(h, nodes, SpacingBound::kSpeed);
    if (best_->load >= kNearEnough) return;
    const bool at_finest = h <= admissible(finest_m_);
    if (tooMany(nodes / kNearEnough)) best_->bound = SpacingBound::kNodes;
    if (at_finest)
      best_->bound = memory_ && finest_m_ > limits_.finest_m ? SpacingBound::kMemory : SpacingBound::kSolver;
  }
  bool atItsFinest(double h, double nodes) const { return h <= admissible(finest_m_) || tooMany(nodes / kNearEnough); }

  const std::function<size_t(double)>& count_;
  const SpacingLimits& limits_;
  double finest_m_, empty_m_ = std::numeric_limits<double>::infinity();
  bool memory_ = false;
  NodeLaw law_{};
  std::optional<SpacingChoice> best_, last_;
};

}  // namespace

SpacingChoice chooseSpacing(const std::function<size_t(double)>& nodes, double start_m, const SpacingLimits& limits,
                            const Progress& progress) {
  Search search(nodes, limits);
  search.begin(start_m);
  return search.run(progress);
}

}  // namespace viscera
