// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "solver/processes/suture/chain/chain_run.h"

namespace viscera {

constexpr size_t kMostKnots = 4;    // of a chain: each costs three more solutions of its system
constexpr double kKnotApart = 0.3;  // links, of a knot from a channel or another knot

/// A knot: two points of a chain that meet (docs/thread.md 4). Between them is its loop.
struct ChainKnot {
  double s1 = 0;                        ///< stays where it is on the chain [links]
  double s2 = 0;                        ///< kept: slides, so that the loop is drawn tight
  double friction_n = 0;                ///< along s2 while it is not tied
  Vector3d apart_m = Vector3d::Zero();  ///< from s1 to s2, which do not meet yet
  bool tied = false;
  double holds_n = std::numeric_limits<double>::infinity();  ///< tied, s2 slips at more, and rubs by that
  Vector3d impulse_ns = Vector3d::Zero();                    ///< kept: of the substep, by s2 on s1
  double rub_kg = 0;                                         ///< kept: friction over what slid
  bool out = false;  ///< out: an end of the chain has passed it; from then on it does nothing
};

struct ChainSlide;

/// The knots of a chain in a substep under way: they border the chain's system.
class ChainKnots {
 public:
  void begin(const std::vector<ChainSlide>& slides, const ChainShape& shape, std::vector<ChainKnot>& knots);
  /// Into what is not balanced yet.
  void set(const ChainShape& shape, const std::vector<ChainKnot>& knots, std::vector<ChainMatrix::Unknown>& rest);
  /// @param found  in: the solution without knots; out: with them
  void solve(const ChainShape& shape, const ChainMatrix& matrix, std::vector<ChainKnot>& knots,
             std::vector<ChainMatrix::Unknown>& found);
  /// What the system that was just solved gave, and how it goes on. @returns whether it must be solved again
  /// @param frozen, runs  as of ChainSlides
  bool heed(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainKnot>& knots);
  /// Of the two points of any knot, but for what slides.
  double farthestOff_m(const ChainShape& shape, const std::vector<ChainKnot>& knots) const;

 private:
  static constexpr int kRows = 3 * static_cast<int>(kMostKnots);
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kRows, kRows>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kRows, 1>;

  std::array<ChainRun, kMostKnots> runs_;
  std::vector<std::vector<ChainMatrix::Unknown>> borders_;  ///< [3 knots] what a force of each does
};

}  // namespace viscera
