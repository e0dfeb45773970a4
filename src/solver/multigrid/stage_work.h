// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/stage_solver.h"
#include "solver/multigrid/tr_bdf2.h"

namespace viscera::multigrid {

/// What a backend that keeps its own vectors does for a step: the state at the start of the step, an increment, what
/// touches nodes, and the system that Newton's method makes of it. stepTrBdf2() and stepEuler() say in which order.
class StageWork {
 public:
  virtual ~StageWork() = default;

  /// What is known of an increment where all was evaluated.
  struct Balance {
    double residual_n = 0;  ///< norm over those who are solved for
    double noise_n = 0;     ///< norm of the rounding of forces in float32
    bool changed = false;   ///< others are held or pressed than before
    Energy energy;
    double lag_j = 0;    ///< what implicit Euler adds to the potential: inertia towards dy
    double given_j = 0;  ///< work of who touches, by their last forces
    double potential_j() const { return lag_j + energy.sum_j - energy.kinetic_j; }
  };
  /// Of conjugate gradients.
  struct Iteration {
    double rz = 0, curvature = 0;  ///< where one is not positive, nothing was done
    double left_n = 0;             ///< residual of the system
  };

  virtual void begin(const Stage& stage) = 0;
  virtual Energy start() = 0;           ///< of the step; linearises there
  virtual void beginTrapezoidal() = 0;  ///< after start()
  virtual void beginBdf2() = 0;
  virtual void beginEuler() = 0;
  virtual void setShare(double share) = 0;  ///< of the step that the stage ends at
  virtual Balance balance() = 0;            ///< of the increment; linearises there
  virtual Iteration iterate(bool first) = 0;
  virtual void addSolution(bool tame) = 0;  ///< to the increment

  virtual void keep() = 0;               ///< the increment, for the next ones of these
  virtual void goBack(float share) = 0;  ///< to kept + share (increment - kept)
  virtual void take(float share) = 0;    ///< of the one that was kept
  virtual void guess(float share) = 0;   ///< share dy
  virtual void slow(float times) = 0;    ///< velocities
};

/// A step of TR-BDF2, as TrBdf2 makes it. @return done: else energy would have grown or something was not finite
bool stepTrBdf2(StageWork& stages, double dt_s, bool touching, SolverWork& work);
/// A step of implicit Euler that is safe from any state, as ImplicitEuler makes it.
void stepEuler(StageWork& stages, double dt_s, bool touching, SolverWork& work);

}  // namespace viscera::multigrid
