// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/step_rules.h"

#include <algorithm>

#include "viscera/math/error.h"

namespace viscera::multigrid {

void requireSteppable(const Model& model, bool node_contacts) {
  if (model.hasNetwork())
    throw SceneError(
        "solver.integrator: multigrid steps implicit lattices, not bodies with explicit connections: use leapfrog or "
        "pd");
  if (node_contacts)
    throw SceneError(
        "solver.integrator: multigrid knows no contacts between nodes (collision.enabled): use leapfrog or pd");
}

Stage trBdf2Stage(double dt_s) {
  const double c = kSecond * dt_s;
  return {1 / (c * c), 1 / c};
}

float keptSpeed(const Energy& before, const Energy& after, double given_j) {
  if (!std::isfinite(after.sum_j)) return 0;
  const double excess_j = after.sum_j - before.sum_j - kGivenTimes * std::max(0.0, given_j) -
                          kTrBdf2Rounding * (before.kinetic_j + std::abs(before.sum_j));
  if (excess_j > kTakes * after.kinetic_j) return 0;
  return excess_j <= 0 ? 1 : static_cast<float>(std::sqrt(1 - excess_j / after.kinetic_j));
}

bool isSolved(const Rule& rule, int step, bool changed, double left_n, double before_n, double noise_n) {
  const bool done = step > 0 && !changed && left_n <= rule.again * before_n;
  return done || left_n <= noise_n || step >= rule.newton + (changed ? kMoreTouched : 0);
}

Rule eulerRule() {
  Rule rule;
  rule.newton = 1;
  rule.again = 0;
  rule.tame = false;
  return rule;
}

}  // namespace viscera::multigrid
