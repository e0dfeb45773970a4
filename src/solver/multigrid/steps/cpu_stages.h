// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/steps/stage_work.h"
#include "solver/multigrid/steps/touching.h"

namespace viscera::multigrid {

/// Vectors of a step on the CPU.
class CpuStages final : public StageWork {
 public:
  CpuStages(const Model& model, const CpuLattice& lattice, const Parallel& parallel);

  /// After solver.start and `before` were written. @param touching  of this step, begun; null: nothing is about
  void beginStep(const Substep& step, Touching* touching);

  bool touching() const override { return touching_ != nullptr; }
  void begin(const Stage& stage) override { solver.begin(stage); }
  Energy start() override;
  void beginStage(uint32_t stage) override;
  void setShare(double share) override;
  Balance balance(bool tangent) override;
  Balance lookAgain(const Balance& /*known*/) override { return balance(false); }
  Energy energy() const override;
  double lag_j() const override;
  double given_j() const override { return touching_ ? touching_->work(increment) : 0; }
  Iteration iterate(bool first) override;
  void addSolution(bool tame) override;
  void become(uint32_t what, float share) override;

  StageSolver solver;
  Vectors before;  ///< velocity at the start of the step
  Vectors increment;

 private:
  void beginTrapezoidal();
  void beginBdf2();
  template <class Each>
  void forComponents(const Each& each);

  Vectors kept_;
  std::vector<float> even_;  ///< increments of nodes that go on evenly, three each
  Touching* touching_ = nullptr;
  float dt_s_ = 0;
  bool tangent_ = false;  ///< it is that of the increment
};

}  // namespace viscera::multigrid
