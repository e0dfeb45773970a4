// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "solver/processes/suture/chain/chain_run.h"

namespace viscera {

constexpr size_t kMostKnots = 4;    // per chain: each costs three more solutions of its system
constexpr double kKnotApart = 0.3;  // distance of a knot from a channel or another knot, in links

/// A knot: two points of a chain that meet (docs/physics.md 14). Between them is its loop.
struct ChainKnot {
  double s1 = 0;          ///< fixed position on the chain [links]
  double s2 = 0;          ///< kept: sliding position on the chain [links], by which the loop is drawn tight
  double friction_n = 0;  ///< along s2 while it is not tied
  Vector3d apart_m = Vector3d::Zero();  ///< vector from s1 to s2 while they do not meet yet
  bool tied = false;
  double holds_n =
      std::numeric_limits<double>::infinity();  ///< force at which s2 slips when tied, and its friction then
  Vector3d impulse_ns = Vector3d::Zero();       ///< kept: impulse of the substep, by s2 on s1
  double rub_kg = 0;                            ///< kept: friction over the slip
  bool out = false;  ///< out: an end of the chain has passed it; it has no effect from then on
};

struct ChainSlide;

/// The knots of a chain in the current substep: they border the chain's linear system.
class ChainKnots {
 public:
  void begin(const std::vector<ChainSlide>& slides, const ChainShape& shape, std::vector<ChainKnot>& knots);
  /// Adds the knots' forces to the residual.
  void set(const ChainShape& shape, const std::vector<ChainKnot>& knots, std::vector<ChainMatrix::Unknown>& rest);
  /// Solves the bordered system. @param found  in: the solution without knots; out: with them
  void solve(const ChainShape& shape, const ChainMatrix& matrix, std::vector<ChainKnot>& knots,
             std::vector<ChainMatrix::Unknown>& found);
  /// Updates the knots with the solution of the system. @returns whether it must be solved again
  /// @param frozen, runs  as in ChainSlides
  bool update(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainKnot>& knots);
  /// Returns the largest distance of the two points of any knot, without slip.
  double farthestOff_m(const ChainShape& shape, const std::vector<ChainKnot>& knots) const;

 private:
  static constexpr int kRows = 3 * static_cast<int>(kMostKnots);
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kRows, kRows>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kRows, 1>;

  std::array<ChainRun, kMostKnots> runs_;
  std::vector<std::vector<ChainMatrix::Unknown>> borders_;  ///< [3 knots] responses to a unit force of each
};

}  // namespace viscera
