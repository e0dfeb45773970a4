// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "bench/harness/specimens/block.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

/// A motion to compute: the model, its initial state, and the motions of the tools in each tick.
struct Experiment {
  Model model;
  Scene scene;                       ///< tick, gravity, styluses; stability monitor off
  HostState start;                   ///< displacements and velocities at time 0
  std::vector<ToolMotions> motions;  ///< [ticks]
  double dt_safe_s = 0;

  double duration_s() const { return static_cast<double>(motions.size()) / scene.solver.tick_hz; }
};

/// A method of time integration.
struct Method {
  Integrator integrator = Integrator::kLeapfrog;
  int substeps = 1;    ///< number per tick
  int iterations = 1;  ///< number per substep, for iterative methods

  bool iterates() const { return traitsOf(integrator).iterates; }  ///< whether it iterates a given number of times
  /// Returns the number of gathers over all nodes per tick, the common cost of an explicit substep and an implicit
  /// iteration.
  int sweeps() const { return substeps * (iterates() ? iterations : 1); }
  bool operator==(const Method& other) const {
    return std::tie(integrator, substeps, iterations) == std::tie(other.integrator, other.substeps, other.iterations);
  }
};
std::string nameOf(Integrator integrator);

/// The result of an experiment.
struct Track {
  std::vector<Field> u_m;  ///< [ticks] displacements at the end of each tick
  double wall_s = 0;       ///< wall-clock time without compiling kernels [s]
};

/// Creates an experiment without stability monitor and sleep. A tick is `tick_in_dt_safe` times the largest stable
/// substep.
Experiment experimentOf(Model model, double tick_in_dt_safe, int ticks);

/// Runs an experiment in float32.
Track runOn(Backend backend, const Experiment& experiment, const Method& method);
/// Runs an experiment in float64. @param substeps  per tick
Track runReference(const Experiment& experiment, int substeps,
                   ReferenceIntegrator integrator = ReferenceIntegrator::kLeapfrog);
/// Extrapolates two tracks with substeps 2 dt and dt to dt -> 0 (Richardson). @param order  order of their error
Track extrapolated(const Track& coarse, const Track& fine, int order);

/// Nodal errors at the ends of all ticks, relative to the largest displacement of the reference.
struct Misfit {
  double rms = 0, max = 0;
};
Misfit misfit(const Model& model, const Track& track, const Track& truth);

/// Returns the larger error; NaN if either is NaN.
double worse(double a, double b);

/// Returns the order of convergence: log2 of the ratio of errors when the substep is halved.
double slope(double coarse_error, double fine_error);

}  // namespace viscera::bench
