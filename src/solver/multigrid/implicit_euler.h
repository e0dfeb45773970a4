// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/touching.h"

namespace viscera::multigrid {

/// Steps of implicit Euler that are safe from any state: the potential falls in all of them, and energy does not grow
/// unless tools bring it in (physics.md 2). First order; damps.
class ImplicitEuler {
 public:
  explicit ImplicitEuler(StageSolver& solver);

  /// Solves for increments. @param touching  of this step, begun; null: nothing is about
  void step(const Substep& step, const Vectors& displacement_m, const Vectors& velocity_m_per_s, Touching* touching,
            SolverWork& work);
  Vectors& increment() { return increment_; }

 private:
  double potential(Vectors& increment, Touching* touching);
  double improve(double potential_j, Touching* touching, SolverWork& work);
  void bound(const Energy& before, Touching* touching);

  StageSolver& solver_;
  Vectors increment_, trial_;
};

}  // namespace viscera::multigrid
