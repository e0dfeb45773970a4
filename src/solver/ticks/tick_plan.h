// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "solver/contact/environment.h"
#include "solver/tissue/substeps.h"
#include "viscera/model/model.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct Scene;

struct SolverOptions {
  bool allow_unstable = false;  ///< take a substep that is too long for the integrator, to study the stability monitor
  /// CPU threads shared with others; null: its own, as many as solver.threads.
  std::shared_ptr<ThreadPool> threads = nullptr;
};

/// Plan of a scene's ticks, known before anything is built. Backends are built for it, and TissueStepper follows it.
struct TickPlan {
  double tick_s = 0;
  double dt_safe_s = 0;        ///< largest stable substep of whole tissue at rest
  double attached_per_s2 = 0;  ///< attachmentRate()
  SubstepPlan substeps;        ///< substeps of whole tissue
  int recovery_substeps = 0;   ///< substeps of a tick in a recovery; 0 without a stability monitor
  bool recovers_by_pd = true;  ///< false: recovers by shorter substeps of the scene's integrator; only springs have pd
  int most_by_strain = 0;      ///< most substeps of strained tissue of a hyperelastic law; 0 without such a law
  bool tools = false;          ///< there are styluses
  std::optional<Environment> environment;  ///< environment at time 0; only where a scene has any

  bool governed() const { return recovery_substeps > 0; }
  /// Returns whether nodes at rest may be moved: then none may sleep.
  bool staysAwake() const { return environment && environment->keepsAwake(); }
  double shortestSubstep_s() const { return tick_s / substeps.strained; }
  int mostSubsteps() const {
    return std::max({substeps.strained, recovery_substeps, most_by_strain});
  }  ///< largest number of substeps of a tick
};

/// Plans the ticks of a scene. @throws SceneError  substeps (planSubsteps), environment (Environment), features
/// (requireFeatures)
TickPlan planTicks(const Model& model, const Scene& scene, const SolverOptions& options = {});

}  // namespace viscera
