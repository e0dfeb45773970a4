// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/experiment.h"
#include "bench/suites/stability/stability_starts.h"

namespace viscera::bench {

constexpr double kStabilitySpacing_m = 0.005;
/// Of the start's energy: what may stay folded after a second of extremeStarts(). Cells turned inside out that lean on
/// each other rest so, 0.064 of it at most where this was chosen; what does not get out of its start has all of it.
constexpr double kStillFolded = 0.1;

/// A box of the law, askew to its lattice, so that cells in part are among its own.
Model askewBox(int cells, double poisson_ratio);

/// What became of a session.
struct Outcome {
  bool finite = true;  ///< no node was ever published that is not finite
  /// Largest energy at the end of a tick over that of the start; one without energy counts as a millionth of M c_p^2.
  double energy_ratio = 0;
  double over_bound = 0;       ///< largest energy over what the governor lets pass, 2 (start + M c_p^2)
  double energy_left = 0;      ///< over that of the start, at the end
  bool had_energy = true;      ///< at the start
  uint64_t trips = 0;          ///< of the governor
  int frames_to_recover = -1;  ///< ticks until energy fell below a hundredth of the start's; -1: it did not
  int ticks = 0;
  std::vector<double> energies;  ///< [ticks] over that of the start
};

/// A scene whose substep is `ratio` times the integrator's limit: that of stableFraction() for explicit ones, dt_safe
/// for the others; ticks of 1/60 s, or of one substep where that is longer.
Scene sceneAt(const Model& model, Integrator integrator, double ratio);

/// Steps the model on a backend from a start and looks at it after every tick.
/// @param ticks  at most; fewer where an integrator needs many sweeps per tick
Outcome tryStart(Backend backend, const Model& model, const Scene& scene, const Start& start, int ticks);

}  // namespace viscera::bench
