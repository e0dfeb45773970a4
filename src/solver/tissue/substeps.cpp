// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/substeps.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kMicro = 1e6;

int count(const SolverConfig& config, double fraction, double dt_safe_s) {
  const double wanted = std::ceil(1.0 / (config.tick_hz * fraction * dt_safe_s));
  if (wanted > config.max_substeps) {
    throw SceneError("a tick of 1/" + numberText(config.tick_hz) + " s needs " + std::to_string(std::lround(wanted)) +
                     " substeps (stable substep " + numberText(dt_safe_s * kMicro) +
                     " us), more than solver.max_substeps = " + std::to_string(config.max_substeps) +
                     ". Use a larger spacing_m, a softer or heavier material, or raise solver.max_substeps");
  }
  return std::max(1, static_cast<int>(wanted));
}

void requireStable(const Model& model, const SolverConfig& config, double dt_safe_s) {
  const double limit_s = stableFraction(config.integrator, largestDashpot(model)) * dt_safe_s;
  const double dt_s = 1.0 / (config.tick_hz * config.substeps);
  if (dt_s < limit_s) return;
  throw SceneError(
      "solver.substeps = " + std::to_string(config.substeps) + " gives substeps of " + numberText(dt_s * kMicro) +
      " us, but this integrator is stable only below " + numberText(limit_s * kMicro) + " us; use at least " +
      std::to_string(std::lround(std::floor(1.0 / (config.tick_hz * limit_s)) + 1)) + " substeps, or integrator pd");
}

}  // namespace

double largestDashpot(const Model& model) {
  double xi = 0;
  for (const Body& body : model.bodies) xi = std::max(xi, body.material.stiffness_damping_ratio);
  return xi;
}

SubstepPlan planSubsteps(const Model& model, const SolverConfig& config, double dt_safe_s, bool allow_unstable) {
  if (config.substeps > 0) {
    if (!allow_unstable) requireStable(model, config, dt_safe_s);
    return {config.substeps, config.substeps};
  }
  SubstepPlan plan;
  plan.calm = plan.strained = count(config, config.dt_fraction, dt_safe_s);
  const bool shortens = config.stability_monitor && traitsOf(config.integrator).shortens;
  if (shortens && config.dt_fraction_strained < config.dt_fraction)
    plan.strained = count(config, config.dt_fraction_strained, dt_safe_s);
  return plan;
}

}  // namespace viscera
