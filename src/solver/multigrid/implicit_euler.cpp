// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/implicit_euler.h"

#include <cmath>

#include "solver/multigrid/step_rules.h"

namespace viscera::multigrid {

ImplicitEuler::ImplicitEuler(StageSolver& solver)
    : solver_(solver), increment_(solver.start.size()), trial_(solver.start.size()) {}

/// What a step lowers, without dashpots [J]. Leaves all evaluated there.
double ImplicitEuler::potential(Vectors& increment, Touching* touching) {
  const FineLevel& level = solver_.level;
  const size_t n = level.places();
  solver_.residual(increment, touching, nullptr, false);
  const auto inertia = static_cast<float>(solver_.stage.inertia_per_s2);
  const double lag_j = level.sum([&](size_t i) {
    double off2 = 0;
    for (size_t j = i; j < 3 * n; j += n) {
      const float off = increment[j] - solver_.wanted[j];
      off2 += static_cast<double>(off * off);
    }
    return off2 * static_cast<double>(0.5f * level.movable()[i] * inertia * level.mass()[i]);
  });
  const Energy at = solver_.energy(solver_.displacement, solver_.velocity, solver_.elastic_j);
  return lag_j + at.sum_j - at.kinetic_j;
}

/// A Newton step, or as much of it as lowers the potential. @return that
double ImplicitEuler::improve(double before_j, Touching* touching, SolverWork& work) {
  trial_ = increment_;
  solver_.solve(increment_, eulerRule(), work, touching);
  for (int halving = 0; halving < kEulerHalvings; ++halving) {
    const double after_j = potential(increment_, touching);
    if (after_j <= before_j + kEulerRounding * std::abs(before_j)) return after_j;
    for (size_t i = 0; i < trial_.size(); ++i) increment_[i] = trial_[i] + 0.5f * (increment_[i] - trial_[i]);
  }
  increment_ = trial_;
  return potential(increment_, touching);
}

/// Keeps as much of the increments as does not raise the energy but by what tools bring in.
void ImplicitEuler::bound(const Energy& before, Touching* touching) {
  trial_ = increment_;
  for (const float share : kEulerKept) {
    for (size_t i = 0; i < trial_.size(); ++i) increment_[i] = share * trial_[i];
    solver_.residual(increment_, touching, nullptr, false);
    const Energy after = solver_.energy(solver_.displacement, solver_.velocity, solver_.elastic_j);
    const double given_j = touching ? std::max(0.0, kGivenTimes * touching->work(increment_)) : 0;
    if (after.sum_j <= before.sum_j + given_j + kEulerRounding * (before.kinetic_j + std::abs(before.sum_j))) return;
  }
}

void ImplicitEuler::step(const Substep& step, const Vectors& u, const Vectors& v, Touching* touching,
                         SolverWork& work) {
  const double dt_s = static_cast<double>(step.dt_s);
  solver_.begin({1 / (dt_s * dt_s), 1 / dt_s});
  solver_.gravity = step.gravity;
  solver_.start = u;
  solver_.level.hold({});
  const Energy before = solver_.energy(u, v, solver_.level.evaluate(u, v));
  for (size_t i = 0; i < v.size(); ++i) solver_.wanted[i] = step.dt_s * v[i];
  std::fill(solver_.offset.begin(), solver_.offset.end(), 0.0f);
  std::fill(increment_.begin(), increment_.end(), 0.0f);
  if (touching) touching->setShare(1);
  double least_j = 0;
  bool first = true;
  for (const float share : {0.0f, 1.0f, 0.5f}) {
    for (size_t i = 0; i < v.size(); ++i) trial_[i] = share * solver_.wanted[i];
    const double there_j = potential(trial_, touching);
    if (first || there_j < least_j) {
      least_j = there_j;
      increment_ = trial_;
    }
    first = false;
  }
  double most = solver_.residual(increment_, touching, nullptr, false);
  for (int k = 0; k < kEulerNewton; ++k) {
    const double before_j = least_j;
    least_j = improve(least_j, touching, work);
    const double norm = solver_.residual(increment_, touching, nullptr, false);
    if (norm <= kEulerEnough * most || !(least_j < before_j)) break;
    most = std::max(most, norm);
  }
  bound(before, touching);
}

}  // namespace viscera::multigrid
