// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "bench/harness/specimens/block.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

/// A motion to be computed: what moves, from which state, what the styluses do in each tick.
struct Experiment {
  Model model;
  Scene scene;                       ///< tick, gravity, styluses; governor off
  HostState start;                   ///< displacements and velocities of time 0
  std::vector<ToolMotions> motions;  ///< [ticks]
  double dt_safe_s = 0;

  double duration_s() const { return static_cast<double>(motions.size()) / scene.solver.tick_hz; }
};

/// How it is computed.
struct Method {
  Integrator integrator = Integrator::kLeapfrog;
  int substeps = 1;    ///< per tick
  int iterations = 1;  ///< per substep, of those who iterate

  bool iterates() const { return traitsOf(integrator).iterates; }  ///< as often as it says
  /// Gathers over all nodes per tick: what an explicit substep and an implicit iteration cost alike.
  int sweeps() const { return substeps * (iterates() ? iterations : 1); }
  bool operator==(const Method& other) const {
    return std::tie(integrator, substeps, iterations) == std::tie(other.integrator, other.substeps, other.iterations);
  }
};
std::string nameOf(Integrator integrator);

/// What came out of it.
struct Track {
  std::vector<Field> u_m;  ///< [ticks] displacements at the end of each
  double wall_s = 0;       ///< without compiling kernels
};

/// No governor, no sleep. Ticks are `tick_in_dt_safe` times the largest stable substep long.
Experiment experimentOf(Model model, double tick_in_dt_safe, int ticks);

/// In float32.
Track runOn(Backend backend, const Experiment& experiment, const Method& method);
/// In float64. @param substeps  per tick
Track runReference(const Experiment& experiment, int substeps,
                   ReferenceIntegrator integrator = ReferenceIntegrator::kLeapfrog);
/// Richardson: what two tracks of substeps 2 dt and dt say of dt -> 0. @param order  of their error
Track extrapolated(const Track& coarse, const Track& fine, int order);

/// Nodal errors at the ends of all ticks over the largest displacement of the truth.
struct Misfit {
  double rms = 0, max = 0;
};
Misfit misfit(const Model& model, const Track& track, const Track& truth);

/// The larger one; not a number if either is none.
double worse(double a, double b);

/// log2 of what halving the substep divides the error by.
double slope(double coarse_error, double fine_error);

}  // namespace viscera::bench
