// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/store/cpu_stepper.h"
#include "solver/multigrid/steps/cpu_stages.h"

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
  void persist(Archive& archive, CpuLattice& lattice) override;
  SolverWork work() const override { return work_; }

 private:
  void followSprings();
  void gather(const CpuLattice& lattice, float dt_s);
  void scatter(CpuLattice& lattice, const Substep& step);

  multigrid::CpuStages stages_;
  multigrid::StageSolver& solver_;  ///< of them
  multigrid::Touching touching_;
  multigrid::Vectors left_;  ///< velocity at the end of the last step
  bool fresh_ = true;        ///< there was no last one
  SolverWork work_;
  bool springs_changed_ = false;
  int steps_since_cut_ = -1;  ///< -1: the hierarchy is that of the lattice as it is
};

}  // namespace viscera
