// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/reference/reference_solver.h"
#include "viscera/math/error.h"

namespace viscera {

/// An iteration that did not reach its tolerance: iterations done and what is left.
struct ConvergenceError : Error {
  using Error::Error;
};

/// One axis of one node held at a displacement.
struct PrescribedDof {
  uint32_t slot;
  int axis;  ///< 0..2
  double u_m;
};

struct StaticsOptions {
  int load_steps = 1;        ///< prescribed displacements and forces are reached in equal steps
  int max_iterations = 200;  ///< per load step
  double tolerance = 1e-10;  ///< largest residual force over the largest of all forces that balance
};

struct StaticsReport {
  int iterations = 0;
  double residual = 0;  ///< as in StaticsOptions::tolerance
};

/// Static equilibrium of elastic energy, gravity and external forces: Newton's method with line search, from
/// solver.u_m. Nodes that are fixed, held or lone stay where they are. Leaves u in solver.u_m and zero velocities.
/// @param external_n  [slots] forces on nodes, or empty
/// @throws ConvergenceError
StaticsReport solveStatics(ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                           const Field& external_n = {}, const StaticsOptions& options = {});

/// The same for infinitesimal displacements about rest, by one factorisation of the rest stiffness; no gravity.
/// @return displacements [slots]; the solver is left as it is
/// @throws ConvergenceError  the prescribed displacements leave a rigid motion free
Field solveLinear(const ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                  const Field& external_n = {});

/// Forces that would hold every node where it is, -(elastic force) [slots, N]: sum over an end face for its reaction.
Field reactions(const ReferenceSolver& solver);
/// The same for the linear solution: K u of the rest stiffness.
Field linearReactions(const ReferenceSolver& solver, const Field& u_m);

}  // namespace viscera
