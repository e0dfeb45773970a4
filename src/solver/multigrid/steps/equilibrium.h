// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// How a static state was come by.
struct SettleReport {
  bool settled = false;    ///< to kSettled: in forces, or in displacements where float32 leaves more of forces
  double residual = 0;     ///< norm of what forces lack over that of the load
  double last_change = 1;  ///< of displacements in the last whole Newton step that was solved for, over their norm
  int newton = 0;          ///< systems solved
  int iterations = 0;      ///< of conjugate gradients
  double seconds = 0;      ///< of all of it but the hierarchy
  double build_s = 0;      ///< of the hierarchy
  double forces = 0;       ///< evaluations of all forces on the finest level; those of some nodes by their share
  double products = 0;     ///< with the tangent there, which cost no more than these
  double largest_m = 0;    ///< displacement
};

/// To which part of load or displacements equilibria are solved.
constexpr double kSettled = 1e-4;
/// The most that forces may lack, over the load, where displacements change no more: what float32 leaves is below.
constexpr double kMostLeft = 1e-2;

/// The state in which elastic forces, gravity and the forces on bodies balance, velocities 0: Newton's method with a
/// line search on the energy, its systems solved by multigrid (physics.md 2). Without obstacles, wind and tools.
/// @throws SceneError  a body that nothing holds, a body with explicit connections
/// @throws Error       no balance was found
HostState equilibriumOf(const Model& model, const Scene& scene, SettleReport& report,
                        const std::shared_ptr<ThreadPool>& threads = nullptr);

}  // namespace viscera
