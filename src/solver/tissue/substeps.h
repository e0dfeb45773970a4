// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/integrators.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

/// How many substeps a tick has (physics.md 2).
struct SubstepPlan {
  int calm = 1;      ///< in ordinary states
  int strained = 1;  ///< of who shortens them, while the governor finds the tissue strained: at least as many
};

/// Substeps below this lose float32 digits of u unless they are summed with compensation [s] (physics.md 2).
constexpr double kShortSubstep_s = 50e-6;
/// Are u and v summed with compensation? @param dt_s  shortest substep
constexpr bool isCompensated(const SolverConfig& config, double dt_s) {
  return traitsOf(config.integrator).compensates && (config.compensated || dt_s < kShortSubstep_s);
}

double largestDashpot(const Model& model);  ///< dashpot_ratio of all bodies

/// @param allow_unstable  do not refuse a substep that is too long: for those who study what happens then
/// @throws SceneError  more substeps than max_substeps; substeps given that are too long for an explicit integrator,
/// with
///                     the number that would do
SubstepPlan planSubsteps(const Model& model, const SolverConfig& config, double dt_safe_s, bool allow_unstable = false);

}  // namespace viscera
