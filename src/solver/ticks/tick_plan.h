// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "solver/contact/surroundings.h"
#include "solver/tissue/substeps.h"
#include "viscera/model/model.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct Scene;

struct SolverOptions {
  bool allow_unstable = false;  ///< take a substep that is too long for the integrator: to study the governor
  /// On the CPU: shared with others; null: solver.threads of its own.
  std::shared_ptr<ThreadPool> threads = nullptr;
};

/// What is known of a scene's ticks before anything is built: backends are built for it, and Ticks goes by it.
struct TickPlan {
  double tick_s = 0;
  double dt_safe_s = 0;        ///< largest stable substep of whole tissue at rest
  SubstepPlan substeps;        ///< of whole tissue
  int recovery_substeps = 0;   ///< of a tick in which the governor's recovery goes on; 0 where there is no governor
  bool recovers_by_pd = true;  ///< else by shorter substeps of the scene's integrator: springs alone have pd
  int most_by_strain = 0;      ///< substeps that strained tissue of a hyperelastic law may need; 0 without
  bool tools = false;          ///< there are styluses
  std::optional<Surroundings> surroundings;  ///< at time 0; only where a scene has any

  bool governed() const { return recovery_substeps > 0; }
  /// May nodes be moved that are at rest? Then none may sleep.
  bool staysAwake() const { return surroundings && surroundings->keepsAwake(); }
  double shortestSubstep_s() const { return tick_s / substeps.strained; }
  int mostSubsteps() const {
    return std::max({substeps.strained, recovery_substeps, most_by_strain});
  }  ///< a tick can have
};

/// @throws SceneError  substeps (planSubsteps), surroundings (Surroundings), features (requireFeatures)
TickPlan planTicks(const Model& model, const Scene& scene, const SolverOptions& options = {});

}  // namespace viscera
