// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/substeps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lattices.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/solver/material.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSubstepsSpacing_m = 0.01;
constexpr double kSubstepsRounding = 1e-6;  // of a substep: dt_safe is computed from float32 k and m

Model stepped(Weights weights = Weights::kCell) {
  return modelOf({boxBody({3, 3, 3}, kSubstepsSpacing_m, weights)});
}

/// Returns a configuration with a tick of this many substeps of dt_safe [1].
SolverConfig configFor(double dt_safe_s, double substeps_of_dt_safe, Integrator integrator) {
  SolverConfig config;
  config.integrator = integrator;
  config.tick_hz = 1 / (substeps_of_dt_safe * dt_safe_s);
  return config;
}

constexpr Integrator kExplicit[] = {Integrator::kLeapfrog, Integrator::kVerletPaper};

}  // namespace

TEST(StableSubstep, IsThatOfTheStiffestNodeAndNotOfTheFastestModeAtRest) {
  const Model model = stepped();
  const MaterialConfig& material = model.bodies[0].material;
  const Elasticity e =
      elasticity(material.young_modulus_pa, material.poisson_ratio, material.density_kg_per_m3, kSubstepsSpacing_m);
  const double unit_s = std::sqrt(e.cell_mass_kg / e.spring_n_per_m);
  // physics.md 2: sqrt(2 m / sum k), sum k = 18 k; the mode at rest, 2 / sqrt(12 k/m), would allow 1.7 times as much.
  EXPECT_NEAR(safeTimeStep(model), unit_s / 3, kSubstepsRounding * unit_s);
  EXPECT_NEAR(safeTimeStep(stepped(Weights::kPaper)), unit_s / 3, kSubstepsRounding * unit_s);
}

TEST(Substeps, ExplicitIntegratorsRefuseMoreThanTheStableSubstepAndSayWhatWouldDo) {
  Model model = stepped();
  model.bodies[0].material.stiffness_damping_ratio = 0;
  const double dt_safe_s = safeTimeStep(model);
  for (const Integrator integrator : kExplicit) {
    SolverConfig config = configFor(dt_safe_s, 9.5, integrator);
    config.substeps = 9;  // of 1.06 dt_safe
    const std::string message = messageOf<SceneError>([&] { planSubsteps(model, config, dt_safe_s, false); });
    EXPECT_TRUE(says(message, {"solver.substeps = 9", "at least 10 substeps"}));
    config.substeps = 10;
    EXPECT_EQ(planSubsteps(model, config, dt_safe_s, false).calm, 10);
  }
}

TEST(Substeps, DashpotsLowerTheLimitOfLeapfrogAlone) {
  Model model = stepped();
  model.bodies[0].material.stiffness_damping_ratio = 0.2;
  const double dt_safe_s = safeTimeStep(model), limit = stableFraction(Integrator::kLeapfrog, 0.2);
  EXPECT_NEAR(limit * limit + 2 * 0.2 * limit, 1, 1e-12);  // physics.md 2: where f^2 + 2 xi f reaches 1
  SolverConfig config = configFor(dt_safe_s, 9, Integrator::kLeapfrog);
  config.substeps = 10;  // 0.9 dt_safe
  EXPECT_TRUE(says(messageOf<SceneError>([&] { planSubsteps(model, config, dt_safe_s, false); }), {"at least 11"}));
  config.integrator = Integrator::kVerletPaper;  // ignores dashpots
  EXPECT_EQ(planSubsteps(model, config, dt_safe_s, false).calm, 10);
}

TEST(Substeps, ImplicitIntegratorsTakeAnySubstep) {
  const Model model = stepped();
  const double dt_safe_s = safeTimeStep(model);
  SolverConfig config = configFor(dt_safe_s, 100, Integrator::kPd);
  config.substeps = 1;
  EXPECT_EQ(planSubsteps(model, config, dt_safe_s, false).calm, 1);
}

TEST(Substeps, AreAsManyAsTheFractionOfTheStableSubstepNeeds) {
  const Model model = stepped();
  const double dt_safe_s = safeTimeStep(model);
  SolverConfig config = configFor(dt_safe_s, 9.4, Integrator::kLeapfrog);
  config.dt_fraction = 0.8;
  config.dt_fraction_strained = 0.5;
  const SubstepPlan plan = planSubsteps(model, config, dt_safe_s, false);
  EXPECT_EQ(plan.calm, 12);      // 9.4 / 0.8 = 11.75
  EXPECT_EQ(plan.strained, 19);  // 9.4 / 0.5 = 18.8
}
