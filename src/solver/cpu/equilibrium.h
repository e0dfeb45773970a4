// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct Scene;

/// Result of the search for an equilibrium.
struct SettleReport {
  bool settled = false;  ///< both kSettled and kLeft were reached
  double residual = 0;   ///< norm of the unbalanced forces over that of the load
  double left = 0;       ///< estimated distance to the equilibrium over the displacement (norms weighted by mass)
  int substeps = 0;      ///< evaluations of all forces
  double seconds = 0;    ///< total time
  double largest_m = 0;  ///< largest displacement of a node
};

/// Tolerances of `residual` and of `left`. Relative to the largest displacement, the worst node is off by about three
/// times as much as all nodes are on average: 1e-4.
constexpr double kSettled = 1e-4, kLeft = 3e-5;
/// Largest residual that is accepted if nodes no longer move. The rounding errors of float32 in forces between nearly
/// incompressible cells are smaller than this.
constexpr double kLargestResidual = 1e-2;

/// Finds the state in which elastic forces, gravity and `force_n` of bodies balance, with zero velocities. Leapfrog
/// runs from rest with a drag that is critical for the slowest current motion (dynamic relaxation; Papadrakakis 1981),
/// so any structure that leapfrog can step can be settled. Obstacles, wind, contacts and tools do not act.
/// @param threads  to work on; null: as many as in the scene
/// @throws SceneError  a body has no fixed node
/// @throws Error       the forces did not become smaller than the load
HostState equilibriumOf(const Model& model, const Scene& scene, SettleReport& report,
                        const std::shared_ptr<ThreadPool>& threads = nullptr);

}  // namespace viscera
