// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/reference/reference_solver.h"
#include "viscera/math/error.h"

namespace viscera {

/// An iteration did not reach its tolerance; says the iterations done and the residual.
struct ConvergenceError : Error {
  using Error::Error;
};

/// One axis of one node prescribed at a displacement.
struct PrescribedDof {
  uint32_t slot;
  int axis;  ///< 0..2
  double u_m;
};

struct StaticsOptions {
  int load_steps = 1;        ///< prescribed displacements and forces are applied in equal steps
  int max_iterations = 200;  ///< largest number per load step
  double tolerance = 1e-10;  ///< largest residual force over the largest of the balancing forces
};

struct StaticsReport {
  int iterations = 0;
  double residual = 0;  ///< residual, defined as in StaticsOptions::tolerance
};

/// Finds the static equilibrium of elastic energy, gravity and external forces by Newton's method with line search,
/// from solver.u_m. Nodes that are fixed, held or isolated do not move. Leaves u in solver.u_m and zero velocities.
/// @param external_n  [slots] forces on nodes, or empty
/// @throws ConvergenceError
StaticsReport solveStatics(ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                           const Field& external_n = {}, const StaticsOptions& options = {});

/// Returns the solution for infinitesimal displacements about rest, by one factorisation of the rest stiffness; no
/// gravity.
/// @return displacements [slots]; the solver is not changed
/// @throws ConvergenceError  the prescribed displacements leave a rigid motion free
Field solveLinear(const ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                  const Field& external_n = {});

/// Returns the forces that would hold every node in place, -(elastic force) [slots, N]: sum over an end face for its
/// reaction.
Field reactions(const ReferenceSolver& solver);
/// Returns the reactions of the linear solution: K u of the rest stiffness.
Field linearReactions(const ReferenceSolver& solver, const Field& u_m);

}  // namespace viscera
