// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/stage_work.h"

#include <cmath>

#include "solver/multigrid/steps/step_rules.h"

namespace viscera::multigrid {

namespace {

using Balance = StageWork::Balance;

/// Improves the increment until the rule is met. @return what is known of it at the end
Balance solve(StageWork& stages, const Rule& rule, SolverWork& work) {
  Balance now;
  for (int step = 0;; ++step) {
    const double before_n = now.residual_n;
    now = stages.balance(step == 0 || stages.touching());  // most often one system is enough
    if (isSolved(rule, step, now.changed, now.residual_n, before_n, now.noise_n)) return now;
    const auto iterate = [&stages](bool first) { return stages.iterate(first); };
    work.iterations += static_cast<uint64_t>(solveSystem(rule, now.residual_n, iterate));
    ++work.systems;
    stages.addSolution(rule.tame);
  }
}

/// What a step of implicit Euler lowers, without dashpots [J].
double potential(const StageWork& stages) {
  const Energy at = stages.energy();
  return stages.lag_j() + at.sum_j - at.kinetic_j;
}

/// A Newton step, or as much of it as lowers the potential. @return that
double improve(StageWork& stages, double before_j, Balance& now, SolverWork& work) {
  stages.become(layout::kIncrementKeep, 1);
  now = stages.lookAgain(solve(stages, eulerRule(), work));
  for (int halving = 0; halving < kEulerHalvings; ++halving) {
    if (halving > 0) {
      stages.become(layout::kIncrementBack, 0.5f);
      now = stages.balance(false);
    }
    const double after_j = potential(stages);
    if (after_j <= before_j + kEulerRounding * std::abs(before_j)) return after_j;
  }
  stages.become(layout::kIncrementShare, 1);
  now = stages.balance(false);
  return potential(stages);
}

/// Keeps as much of the increments as does not raise the energy but by what tools bring in.
void bound(StageWork& stages, const Energy& before) {
  stages.become(layout::kIncrementKeep, 1);
  for (const float share : kEulerKept) {
    stages.become(layout::kIncrementShare, share);
    stages.balance(false);
    const double after_j = stages.energy().sum_j, given_j = std::max(0.0, kGivenTimes * stages.given_j());
    if (after_j <= before.sum_j + given_j + kEulerRounding * (before.kinetic_j + std::abs(before.sum_j))) return;
  }
}

}  // namespace

bool stepTrBdf2(StageWork& stages, double dt_s, SolverWork& work, const Rule& rule) {
  stages.begin(trBdf2Stage(dt_s));
  const Energy before = stages.start();
  stages.beginStage(layout::kStageTrapezoidal);
  stages.setShare(kGamma);
  solve(stages, rule, work);
  stages.beginStage(layout::kStageBdf2);
  stages.setShare(1);
  solve(stages, rule, work);
  const float kept = keptSpeed(before, stages.energy(), stages.given_j());
  if (kept == 0) return false;
  if (kept < 1) stages.become(layout::kIncrementSlow, kept);
  return true;
}

void stepEuler(StageWork& stages, double dt_s, SolverWork& work) {
  stages.begin({1 / (dt_s * dt_s), 1 / dt_s});
  const Energy before = stages.start();
  stages.beginStage(layout::kStageEuler);
  stages.setShare(1);
  double least_j = 0;
  for (const float share : {0.0f, 1.0f, 0.5f}) {
    stages.become(layout::kIncrementGuess, share);
    stages.balance(false);
    const double there_j = potential(stages);
    if (share != 0 && !(there_j < least_j)) continue;
    least_j = there_j;
    stages.become(layout::kIncrementKeep, 1);
  }
  stages.become(layout::kIncrementShare, 1);
  Balance now = stages.balance(false);
  double most_n = now.residual_n;
  for (int k = 0; k < kEulerNewton; ++k) {
    const double before_j = least_j;
    least_j = improve(stages, least_j, now, work);
    now = stages.lookAgain(now);
    if (now.residual_n <= kEulerEnough * most_n || !(least_j < before_j)) break;
    most_n = std::max(most_n, now.residual_n);
  }
  bound(stages, before);
}

}  // namespace viscera::multigrid
