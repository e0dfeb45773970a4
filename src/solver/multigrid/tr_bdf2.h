// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/stage_solver.h"
#include "solver/substep.h"

namespace viscera::multigrid {

/// Steps of TR-BDF2 (Bank et al. 1985; physics.md 2): second order, damps what a step cannot follow. Both stages have
/// one matrix.
class TrBdf2 {
 public:
  explicit TrBdf2(StageSolver& solver);

  static Stage stageOf(double dt_s);
  /// From `displacement` and `velocity` of the caller's, into the same. @return done: else nothing was changed, as
  /// energy would have grown or something was not finite
  bool step(const Substep& step, Vectors& displacement_m, Vectors& velocity_m_per_s, SolverWork& work);

 private:
  void beginFirst(double dt_s, const Vectors& v);
  void beginSecond(double dt_s, const Vectors& v);
  double energyOf(const Vectors& displacement, const Vectors& velocity, double elastic_j, double& kinetic_j) const;

  StageSolver& solver_;
  Vectors increment_;
};

}  // namespace viscera::multigrid
