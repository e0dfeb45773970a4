// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/vbd.h"
#include "solver/multigrid/tr_bdf2.h"

namespace viscera {

/// Implicit steps as long as a tick, solved by multigrid (physics.md 2). TR-BDF2 where nothing touches the tissue;
/// implicit Euler, with contacts as in vbd, where something does, and where TR-BDF2 would let energy grow.
class CpuMultigrid : public CpuStepper {
 public:
  /// @throws SceneError  bodies with explicit connections, contacts between nodes
  CpuMultigrid(const Model& model, const CpuLattice& lattice, const CpuParts& parts);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;
  void springsChanged() override { springs_changed_ = true; }
  SolverWork work() const override { return work_; }

 private:
  void followSprings();
  bool stepFree(CpuLattice& lattice, const Substep& step);
  void stepTouched(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  void correct(const Substep& step);
  void holdContacts(const Substep& step);
  void gather(const CpuLattice& lattice);

  multigrid::StageSolver solver_;
  multigrid::TrBdf2 tr_bdf2_;
  CpuVbd sweeps_;
  multigrid::Vectors displacement_, velocity_, increment_;
  std::vector<uint32_t> held_;
  std::vector<multigrid::Plane> planes_;
  SolverWork work_;
  bool springs_changed_ = false;
  int steps_since_cut_ = -1;  ///< -1: the hierarchy is that of the lattice as it is
};

}  // namespace viscera
