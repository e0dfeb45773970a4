// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "solver/cpu/store/cpu_lattice.h"
#include "solver/gpu/steps/multigrid_stages.h"
#include "solver/ticks/tick_plan.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// Implicit steps as long as a tick, solved by multigrid (physics.md 2), as CpuMultigrid makes them. The levels are
/// built on the host, which keeps a copy of the lattice for that, and then lie on the GPU.
class MultigridPass : public Stepper {
 public:
  /// @param buffers  that it will be run on
  /// @throws SceneError  bodies with explicit connections, contacts between nodes
  MultigridPass(const Model& model, const Scene& scene, const TickPlan& plan, const FeatureSet& features,
                const LatticeBuffers& buffers);
  void run(LatticeBuffers& buffers, const Substep& step) override;
  void restart() override { fresh_ = true; }
  void springsChanged() override { springs_changed_ = true; }
  void persist(Archive& archive) override;
  SolverWork work() const override { return work_; }

 private:
  MultigridStages::Levels levelsFor(const multigrid::Stage& stage);
  void takeRebuilt();
  void followSprings(const LatticeBuffers& buffers);

  CpuLattice lattice_;  ///< its springs when levels were last built
  std::shared_ptr<ThreadPool> threads_;
  multigrid::FineLevel level_;
  multigrid::BuiltLevels built_;
  std::map<const multigrid::Hierarchy*, MultigridLevels> levels_;
  MultigridStages stages_;
  std::optional<MultigridTouchPass> touch_;  ///< where something may touch
  bool touched_ = false;                     ///< in the last step
  bool fresh_ = true;                        ///< how the last step ended is unknown
  SolverWork work_;
  bool springs_changed_ = false;
  int steps_since_cut_ = -1;  ///< -1: the levels are those of the lattice as it is
};

}  // namespace viscera
