// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/touching.h"

namespace viscera::multigrid {

/// Steps of TR-BDF2 (Bank et al. 1985; physics.md 2): second order, damps what a step cannot follow. Both stages have
/// one matrix.
class TrBdf2 {
 public:
  explicit TrBdf2(StageSolver& solver);

  static Stage stageOf(double dt_s);
  Rule rule;  ///< of both stages
  /// Solves for increments and velocities at the end. @param touching  of this step, begun; null: nothing is about
  /// @return done: else energy would have grown or something was not finite
  bool step(const Substep& step, const Vectors& displacement_m, const Vectors& velocity_m_per_s, Touching* touching,
            SolverWork& work);
  Vectors& increment() { return increment_; }
  Vectors& velocity() { return solver_.velocity; }

 private:
  void beginFirst(double dt_s, const Vectors& v, const Touching* touching);
  void beginSecond(double dt_s, const Vectors& v, Touching* touching);

  StageSolver& solver_;
  Vectors increment_;
  std::vector<float> even_;  ///< increments of nodes that go on evenly, three each
};

}  // namespace viscera::multigrid
