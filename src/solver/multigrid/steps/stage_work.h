// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "layout/multigrid.h"
#include "solver/multigrid/steps/stage_solver.h"

namespace viscera::multigrid {

/// What a backend does for a step: it keeps the vectors, which are the state at the start of the step, an increment and
/// the system that Newton's method makes of it, and knows what touches nodes. stepTrBdf2() and stepEuler() say in which
/// order.
class StageWork {
 public:
  virtual ~StageWork() = default;

  /// Of an increment.
  struct Balance {
    double residual_n = 0;  ///< norm over those who are solved for
    double noise_n = 0;     ///< norm of the rounding of forces in float32
    bool changed = false;   ///< others are held or pressed than before
  };

  virtual bool touching() const = 0;  ///< something may touch nodes in this step
  virtual void begin(const Stage& stage) = 0;
  virtual Energy start() = 0;  ///< of the step; asks for forces there
  /// dy, dw and the first guess of a stage (layout::kStage...), after start() or the solution of the one before.
  virtual void beginStage(uint32_t stage) = 0;
  virtual void setShare(double share) = 0;  ///< of the step that the stage ends at
  /// Puts the increment where it may be, and asks for all that is known of it. @param tangent  a system is likely to be
  /// made of it: of another one it costs more
  virtual Balance balance(bool tangent) = 0;
  /// The same for an increment that was the last one, of which contacts may come or go: where it is cheap.
  virtual Balance lookAgain(const Balance& known) = 0;
  // Where the last balance was:
  virtual Energy energy() const = 0;
  virtual double lag_j() const = 0;    ///< what implicit Euler adds to the potential: inertia towards dy
  virtual double given_j() const = 0;  ///< work of who touches, by their last forces
  virtual Iteration iterate(bool first) = 0;
  virtual void addSolution(bool tame) = 0;  ///< to the increment
  /// What becomes of the increment, or of speeds (layout::kIncrement...).
  virtual void become(uint32_t what, float share) = 0;
};

/// A step of TR-BDF2 (Bank et al. 1985; physics.md 2): second order, damps what a step cannot follow.
/// @return done: else energy would have grown or something was not finite
bool stepTrBdf2(StageWork& stages, double dt_s, SolverWork& work, const Rule& rule = Rule());
/// A step of implicit Euler that is safe from any state: the potential falls in all of them, and energy does not grow
/// unless tools bring it in (physics.md 2). First order; damps.
void stepEuler(StageWork& stages, double dt_s, SolverWork& work);

}  // namespace viscera::multigrid
