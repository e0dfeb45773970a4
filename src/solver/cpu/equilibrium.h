// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct Scene;

/// How an equilibrium was found.
struct SettleReport {
  bool settled = false;  ///< to kSettled and kLeft
  double residual = 0;   ///< norm of the forces that are not balanced, over that of the load
  double left = 0;       ///< estimate of the way to the equilibrium, over the displacement (norms weighted by mass)
  int substeps = 0;      ///< evaluations of all forces
  double seconds = 0;    ///< of all of it
  double largest_m = 0;  ///< largest displacement of a node
};

/// Forces that are left over the load at the end, and `left`. The node that is farthest off lacks some three times as
/// much of the largest displacement as all nodes lack of theirs: 1e-4 there.
constexpr double kSettled = 1e-4, kLeft = 3e-5;
/// Largest residual that is accepted where nodes move no more: float32 leaves less than this of the forces between
/// nearly incompressible cells.
constexpr double kLargestResidual = 1e-2;

/// Finds the state in which elastic forces, gravity and `force_n` of bodies balance, with velocities of 0. Leapfrog
/// runs from rest with a drag that is critical for the slowest motion there is at the time (dynamic relaxation;
/// Papadrakakis 1981), so that every structure that leapfrog steps can be settled. Obstacles, wind, contacts and tools
/// do not act.
/// @param threads  to work on; null: as many as the scene asks for
/// @throws SceneError  a body has no fixed node
/// @throws Error       the forces did not become smaller than the load
HostState equilibriumOf(const Model& model, const Scene& scene, SettleReport& report,
                        const std::shared_ptr<ThreadPool>& threads = nullptr);

}  // namespace viscera
