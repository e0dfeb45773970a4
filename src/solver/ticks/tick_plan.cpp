// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/tick_plan.h"

#include <algorithm>
#include <limits>

#include "model/scene/feature_rules.h"
#include "solver/processes/attach/fibres.h"
#include "solver/ticks/solver_backend.h"
#include "solver/ticks/stable_step.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr int kMostLonger = 2;  // over the proven substep: measured ones were 1.6 to 1.8 times as long (physics.md 2)

/// Substeps that strained cells of a law may have, with motions of tools for each: 1 MB.
constexpr int kMostByStrain = 4000;

/// Returns the planned substeps. Where the limit will be measured, up to twice max_substeps proven ones at rest are
/// accepted, as the measured ones may be few enough.
SubstepPlan planned(const Model& model, const SolverConfig& asked, double dt_safe_s, bool allow_unstable) {
  if (measuresLimit(model, asked)) {
    SolverConfig any = asked;
    any.max_substeps = std::numeric_limits<int>::max();
    try {
      const SubstepPlan plan = planSubsteps(model, any, dt_safe_s, allow_unstable);
      if (plan.calm / kMostLonger <= asked.max_substeps) return plan;
    } catch (const SceneError&) {  // more substeps than fit an int
    }
  }
  return planSubsteps(model, asked, dt_safe_s, allow_unstable);  // the error names the requested numbers
}

}  // namespace

TickPlan planTicks(const Model& model, const Scene& scene, const SolverOptions& options) {
  requireFeatures(scene);
  if (hasLaw(model) && scene.solver.integrator != Integrator::kLeapfrog)
    throw SceneError("the model was built with material.law: neo_hookean, which needs solver.integrator leapfrog");
  TickPlan plan;
  plan.tick_s = 1 / scene.solver.tick_hz;
  plan.dt_safe_s = safeTimeStep(model);
  plan.attached_per_s2 = attachmentRate(scene, model);
  const double dt_safe_s = stepWith(plan.dt_safe_s, plan.attached_per_s2);
  plan.substeps = planned(model, scene.solver, dt_safe_s, options.allow_unstable);
  plan.recovers_by_pd = !hasLaw(model);
  if (scene.solver.stability_monitor) {
    const int sweeps = plan.recovers_by_pd ? SolverBackend::kRecoveryIterations : 1;
    plan.recovery_substeps = std::max(1, plan.substeps.strained / sweeps);
  }
  if (hasLaw(model) && scene.solver.substeps == 0 && plan.governed())
    plan.most_by_strain = std::min(scene.solver.max_substeps, std::max(kMostByStrain, plan.substeps.strained));
  plan.tools = !scene.styluses.empty();
  if (environmentOf(model, scene).any()) plan.environment.emplace(model, scene);
  return plan;
}

}  // namespace viscera
