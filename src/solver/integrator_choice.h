// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "viscera/model/model.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// What `integrator: auto` has become.
struct IntegratorChoice {
  Integrator integrator = Integrator::kLeapfrog;
  std::string reason;  ///< for a person, as in "multigrid, as a tick takes ..."
};

/// Of leapfrog and multigrid the one whose ticks this machine steps in less time, measured on solvers of the scene that
/// are let go in gravity, pressed by a probe where it has styluses, and then forgotten, so that nothing of it is left
/// in the solver that is made. Leapfrog where multigrid has no steps for the scene.
/// @param backend  that will step the scene   @param threads  of the CPU backend, shared with others; may be null
IntegratorChoice chooseIntegrator(const Model& model, const Scene& scene, Backend backend,
                                  const std::shared_ptr<ThreadPool>& threads);

/// What a person should know of probes between nodes: only leapfrog's meet what lies there. Empty where all are as wide
/// as the cells. @param integrator  that steps the scene
std::string thinProbeNote(const Model& model, const Scene& scene, Integrator integrator);

}  // namespace viscera
