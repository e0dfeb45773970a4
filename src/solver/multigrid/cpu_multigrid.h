// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/cpu_stepper.h"
#include "solver/multigrid/implicit_euler.h"
#include "solver/multigrid/tr_bdf2.h"

namespace viscera {

/// Implicit steps as long as a tick, solved by multigrid (physics.md 2). TR-BDF2; implicit Euler where that would let
/// energy grow. What touches the tissue is part of the solution of either.
class CpuMultigrid : public CpuStepper {
 public:
  /// @throws SceneError  bodies with explicit connections, contacts between nodes
  CpuMultigrid(const Model& model, const CpuLattice& lattice, const CpuParts& parts);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;
  void restart() override;
  void springsChanged() override { springs_changed_ = true; }
  SolverWork work() const override { return work_; }

 private:
  void followSprings();
  void gather(const CpuLattice& lattice, float dt_s);
  void scatter(CpuLattice& lattice, const Substep& step, const multigrid::Vectors& increment,
               const multigrid::Vectors& velocity);

  multigrid::StageSolver solver_;
  multigrid::TrBdf2 tr_bdf2_;
  multigrid::ImplicitEuler euler_;
  multigrid::Touching touching_;
  multigrid::Vectors displacement_, velocity_;  ///< at the start of the step
  multigrid::Vectors left_;                     ///< velocity at the end of the last one
  bool fresh_ = true;                           ///< there was no last one
  SolverWork work_;
  bool springs_changed_ = false;
  int steps_since_cut_ = -1;  ///< -1: the hierarchy is that of the lattice as it is
};

}  // namespace viscera
