// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tick_plan.h"

#include "solver/solver_backend.h"
#include "viscera/solver/material.h"

namespace viscera {

TickPlan planTicks(const Model& model, const Scene& scene, const SolverOptions& options) {
  TickPlan plan;
  plan.tick_s = 1 / scene.solver.tick_hz;
  plan.dt_safe_s = safeTimeStep(model);
  plan.substeps = planSubsteps(model, scene.solver, plan.dt_safe_s, options.allow_unstable);
  if (scene.solver.governor)
    plan.recovery_substeps = std::max(1, plan.substeps.strained / SolverBackend::kRecoveryIterations);
  plan.tools = !scene.styluses.empty();
  if (surroundingsOf(model, scene).any()) plan.surroundings.emplace(model, scene);
  return plan;
}

}  // namespace viscera
