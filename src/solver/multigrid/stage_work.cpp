// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/stage_work.h"

#include <cmath>

#include "solver/multigrid/step_rules.h"

namespace viscera::multigrid {

namespace {

using Balance = StageWork::Balance;

/// One system. @return iterations
int solveSystem(StageWork& stages, const Rule& rule, double norm_n) {
  int k = 0;
  double lowered_j = 0;
  while (k < rule.most) {
    const StageWork::Iteration done = stages.iterate(k == 0);
    if (!(done.rz > 0) || !(done.curvature > 0)) break;
    ++k;
    const double lowers_j = done.rz * done.rz / done.curvature;
    lowered_j += lowers_j;
    if (rule.ends(k, lowers_j, lowered_j, done.left_n, norm_n)) break;
  }
  return k;
}

/// Improves the increment until the rule is met. @return all that is known of it at the end
Balance solve(StageWork& stages, const Rule& rule, SolverWork& work) {
  Balance now;
  for (int step = 0;; ++step) {
    const double before = now.residual_n;
    now = stages.balance();
    if (isSolved(rule, step, now.changed, now.residual_n, before, now.noise_n)) return now;
    work.iterations += static_cast<uint64_t>(solveSystem(stages, rule, now.residual_n));
    ++work.systems;
    stages.addSolution(rule.tame);
  }
}

/// A Newton step, or as much of it as lowers the potential.
Balance improve(StageWork& stages, const Balance& before, SolverWork& work) {
  stages.keep();
  Balance after = solve(stages, eulerRule(), work);
  for (int halving = 0; halving < kEulerHalvings; ++halving) {
    if (after.potential_j() <= before.potential_j() + kEulerRounding * std::abs(before.potential_j())) return after;
    stages.goBack(0.5f);
    after = stages.balance();
  }
  stages.take(1);
  return stages.balance();
}

/// Keeps as much of the increments as does not raise the energy but by what tools bring in.
void bound(StageWork& stages, const Energy& before, bool touching) {
  stages.keep();
  for (const float share : kEulerKept) {
    stages.take(share);
    const Balance after = stages.balance();
    const double given_j = touching ? std::max(0.0, kGivenTimes * after.given_j) : 0;
    if (after.energy.sum_j <= before.sum_j + given_j + kEulerRounding * (before.kinetic_j + std::abs(before.sum_j)))
      return;
  }
}

}  // namespace

bool stepTrBdf2(StageWork& stages, double dt_s, bool touching, SolverWork& work) {
  stages.begin(TrBdf2::stageOf(dt_s));
  const Energy before = stages.start();
  stages.beginTrapezoidal();
  stages.setShare(kGamma);
  solve(stages, Rule(), work);
  stages.beginBdf2();
  stages.setShare(1);
  const Balance at = solve(stages, Rule(), work);
  const float kept = keptSpeed(before, at.energy, touching ? at.given_j : 0);
  if (kept == 0) return false;
  if (kept < 1) stages.slow(kept);
  return true;
}

void stepEuler(StageWork& stages, double dt_s, bool touching, SolverWork& work) {
  stages.begin({1 / (dt_s * dt_s), 1 / dt_s});
  const Energy before = stages.start();
  stages.beginEuler();
  stages.setShare(1);
  Balance least;
  for (const float share : {0.0f, 1.0f, 0.5f}) {
    stages.guess(share);
    const Balance there = stages.balance();
    if (share != 0 && !(there.potential_j() < least.potential_j())) continue;
    least = there;
    stages.keep();
  }
  stages.take(1);
  least = stages.balance();
  double most_n = least.residual_n;
  for (int k = 0; k < kEulerNewton; ++k) {
    const double before_j = least.potential_j();
    least = improve(stages, least, work);
    if (least.residual_n <= kEulerEnough * most_n || !(least.potential_j() < before_j)) break;
    most_n = std::max(most_n, least.residual_n);
  }
  bound(stages, before, touching);
}

}  // namespace viscera::multigrid
