// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gpu/readback.h"
#include "solver/gpu/cut_pass.h"
#include "solver/gpu/good_states.h"
#include "solver/gpu/grab_pass.h"
#include "solver/gpu/guard_pass.h"
#include "solver/gpu/lattice_buffers.h"
#include "solver/gpu/measure_pass.h"
#include "solver/gpu/reaction_pass.h"
#include "solver/gpu/stepper.h"
#include "solver/gpu/surroundings_pass.h"
#include "solver/lattice_solver.h"

namespace viscera {

struct GpuSolverOptions : SolverOptions {
  uint32_t group_size = layout::kGroupSize;
};

/// The solver whose state lives on the GPU (OpenGL compute).
class GpuSolver final : public LatticeSolver {
 public:
  /// @param model  must outlive the solver
  /// @throws GpuError  shaders, memory;  SceneError  substeps (planSubsteps), parts (strengths)
  GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options = {});

  std::optional<StateView> stateOnGpu() const override { return state(); }
  StateView state() const;
  HostState readState() const override;
  std::string backend() const override { return "gpu"; }
  /// Times that the host had to wait for measurements: of the tick before, where a governor judges it, or where nobody
  /// governs and the GPU is more than three ticks behind.
  uint64_t waits() const { return stats_ring_.waits(); }

 private:
  struct Tools {  ///< what only a scene with styluses needs
    gpu::Buffer<layout::ToolMotion> motions;
    GrabPass grab;
    CutPass cut;
    ReactionPass reaction;
  };
  struct Recovery {  ///< what only a scene with a governor needs
    GoodStates good;
    GuardPass guard;
    std::unique_ptr<Stepper> stepper;  ///< pd without acceleration: every sweep descends
  };
  void beginTick() override;
  void takeHold(uint32_t stylus, const Pose& pose, double radius_m) override;
  void letGo(uint32_t stylus, const Release& release) override;
  void writeMotions(const std::vector<layout::ToolMotion>& motions) override;
  void selectMotions(size_t substep) override;
  void cut(uint32_t stylus, bool particles) override;
  void advance(const Substep& step, bool recovery) override;
  void beginSurroundings(const Surroundings& surroundings) override;
  void surround(const Substep& step, const Surroundings& surroundings) override;
  void measure() override;
  void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) override;
  void guard(const Governor::Bounds& bounds, const ToolMotions& motions, double tick_s) override;
  int lag() const override { return 1; }
  bool requestStats() override;
  bool takeStats(layout::TickStats& stats, bool wait) override;
  void resetState() override;
  void loadState(const HostState& state) override;
  void saveGood() override;
  void restoreGood(int back) override;
  void clearGood() override;

  FeatureSet features_;
  LatticeBuffers buffers_;
  std::unique_ptr<Stepper> stepper_;
  MeasurePass measure_;
  std::optional<SurroundingsPass> surroundings_;
  std::optional<Tools> tools_;
  std::optional<Recovery> recovery_;
  gpu::ReadbackRing stats_ring_;
};

}  // namespace viscera
