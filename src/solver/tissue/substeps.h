// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/integrators.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

/// Number of substeps of a tick (physics.md 2).
struct SubstepPlan {
  int calm = 1;      ///< number in ordinary states
  int strained = 1;  ///< number in strained tissue, with integrators that shorten substeps; at least `calm`
};

/// Substep below which float32 digits of u are lost unless summed with compensation [s] (physics.md 2).
constexpr double kShortSubstep_s = 50e-6;
/// Returns whether u and v are summed with compensation. @param dt_s  shortest substep [s]
constexpr bool isCompensated(const SolverConfig& config, double dt_s) {
  return traitsOf(config.integrator).compensates && (config.compensated || dt_s < kShortSubstep_s);
}

double largestDashpot(const Model& model);  ///< largest stiffness_damping_ratio of all bodies

/// Plans the substeps of a tick.
/// @param allow_unstable  accept a substep that is too long, to study the effect
/// @throws SceneError  more substeps than max_substeps; or the given substeps are too long for an explicit integrator,
/// with the number that suffices
SubstepPlan planSubsteps(const Model& model, const SolverConfig& config, double dt_safe_s, bool allow_unstable = false);

}  // namespace viscera
