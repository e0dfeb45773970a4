// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/experiment.h"
#include "bench/suites/stability/stability_starts.h"

namespace viscera::bench {

constexpr double kStabilitySpacing_m = 0.005;
/// Share of the start's energy that may remain in inverted cells after a second of extremeStarts(). Inverted cells that
/// support each other keep at most 0.064 of it (measured when this was chosen); a state that does not leave its start
/// keeps all of it.
constexpr double kStillFolded = 0.1;

/// Creates a box of the law, rotated against its lattice, so that some cells are partially filled.
Model askewBox(int cells, double poisson_ratio);

/// The result of a session.
struct Outcome {
  bool finite = true;  ///< whether all published nodes were finite
  /// Largest energy at the end of a tick relative to that of the start; a start without energy counts as a millionth of
  /// M c_p^2.
  double energy_ratio = 0;
  double over_bound = 0;       ///< largest energy relative to the stability monitor's limit, 2 (start + M c_p^2)
  double energy_left = 0;      ///< energy at the end, relative to the start
  bool had_energy = true;      ///< whether the start had energy
  uint64_t trips = 0;          ///< number of trips of the stability monitor
  int frames_to_recover = -1;  ///< ticks until energy fell below a hundredth of the start's; -1: it did not
  int ticks = 0;
  std::vector<double> energies;  ///< [ticks] energy relative to the start
};

/// Returns a scene with a substep of `ratio` times the integrator's limit: that of stableFraction() for explicit ones,
/// dt_safe for the others. Ticks are 1/60 s, or one substep if that is longer.
Scene sceneAt(const Model& model, Integrator integrator, double ratio);

/// Steps the model on a backend from a start and evaluates it after every tick.
/// @param ticks  largest number; fewer if an integrator needs many sweeps per tick
Outcome tryStart(Backend backend, const Model& model, const Scene& scene, const Start& start, int ticks);

}  // namespace viscera::bench
