// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gpu/readback.h"
#include "solver/gpu/buffers/awake_bricks.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/contact/cut_pass.h"
#include "solver/gpu/contact/environment_pass.h"
#include "solver/gpu/contact/grab_pass.h"
#include "solver/gpu/contact/node_pairs.h"
#include "solver/gpu/contact/node_window.h"
#include "solver/gpu/forces/reaction_pass.h"
#include "solver/gpu/good_states.h"
#include "solver/gpu/guard_pass.h"
#include "solver/gpu/measure_pass.h"
#include "solver/gpu/rest_watch.h"
#include "solver/gpu/slow_pass.h"
#include "solver/gpu/steps/stepper.h"
#include "solver/ticks/solver_backend.h"
#include "solver/ticks/tick_plan.h"

namespace viscera {

struct Scene;

struct GpuSolverOptions : SolverOptions {
  uint32_t group_size = layout::kGroupSize;
};

/// Checks that the kernels ran. In tissue that has springs and lost none, the largest rate of a node is not 0. If it
/// is, kernels did not run or worked on invalid memory, which would otherwise look like tissue at rest.
/// @throws GpuError
void requireSignOfLife(const layout::TickStats& stats);

/// The tissue on the GPU (OpenGL compute).
class GpuBackend final : public SolverBackend {
 public:
  /// @param model  must outlive the backend
  /// @param plan  of model and scene; used only during construction
  /// @throws GpuError  shaders, memory;  SceneError  parts (strengths)
  GpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options = {});

  std::string name() const override { return "gpu"; }
  uint64_t waits() const { return stats_ring_.waits(); }  ///< times that the host waited, see GpuSolver

  std::vector<uint8_t> awake() const;  ///< see GpuSolver
  size_t bricks() const { return buffers_.store.bricks.size(); }
  bool resting() const { return rest_.resting(); }

  void beginTick() override;
  void takeHold(uint32_t stylus, const Pose& pose, double radius_m) override;
  void letGo(uint32_t stylus, const Release& release) override;
  void writeMotions(const std::vector<layout::ToolMotion>& motions) override;
  void selectMotions(size_t substep) override;
  void cut(uint32_t stylus, bool particles) override;
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                 std::vector<Vector3f>& v_m_per_s) const override;
  void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                 const std::vector<Vector3f>& dv_m_per_s) override;
  void selectBody(size_t body) override { blade_->body = body; }
  void cutAtRest(const layout::ToolMotion& sweep, bool particles) override;
  void advance(const Substep& step, bool recovery) override;
  void beginEnvironment(const Environment& environment) override;
  void blow(const Substep& step, const Environment& environment) override;
  void surround(const Substep& step, const Environment& environment) override;
  void sumObstacles(const std::vector<Vector3f>& positions) override;
  void measure() override;
  void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) override;
  void guard(const StabilityMonitor::Bounds& bounds, const ToolMotions& motions, double tick_s) override;
  int lag() const override { return kLag; }
  bool requestStats() override;
  bool takeStats(layout::TickStats& stats, bool wait) override;
  HostState readState() const override;
  void snapshot(StateSnapshot& out, uint64_t /*cut_revision*/) const override { copyShown(readState(), out); }
  void readCuts(CutSprings& out) const override;
  std::optional<StateView> stateOnGpu(uint64_t cut_revision) const override;
  void resetState() override;
  void loadState(const HostState& state) override;
  void saveGood() override;
  void restoreGood(int back) override;
  void clearGood() override;
  void persist(Archive& archive) override;

 private:
  static constexpr int kLag = 1;
  void bind() const;
  void disturb();
  void cutBut(uint32_t spared, uint32_t stylus, bool particles);
  void wakeAll();
  struct Tools {  ///< only in scenes with styluses
    gpu::Buffer<layout::ToolMotion> motions;
    GrabPass grab;
    CutPass cut;
    ReactionPass reaction;
  };
  struct Blade {  ///< only for tissue that resists blades or has sutures
    NodeWindow window;
    gpu::Buffer<layout::ToolMotion> sweep;
    gpu::Buffer<layout::vec4> still;  ///< [slots] zeros: displacements and velocities of tissue at rest
    uint32_t resists = 0;             ///< bodies that resist blades, a bit each
    size_t body = 0;                  ///< body that cutAtRest() cuts
    float kernel_m = 0;               ///< largest distance from an edge at which nodes are pushed
    bool looked = false;              ///< nodes were read since motions were written
  };
  struct Recovery {  ///< only in scenes with a stability monitor
    GoodStates good;
    GuardPass guard;
    std::unique_ptr<Stepper> stepper;  ///< pd without acceleration: each sweep lowers the energy; null with a law
    std::optional<SlowPass> slow;      ///< only if a body has a law
  };

  FeatureSet features_;
  LatticeBuffers buffers_;
  std::unique_ptr<NodePairs> pairs_;    ///< null if contacts between nodes are not part of the solution
  std::unique_ptr<AwakeBricks> awake_;  ///< null if nothing sleeps
  RestWatch rest_;
  std::unique_ptr<Stepper> stepper_;
  MeasurePass measure_;
  const bool has_springs_;  ///< nodes that may move have springs, in intact tissue
  bool foreign_ = false;    ///< the state was written from outside: it may have no springs left
  std::optional<EnvironmentPass> environment_;
  std::optional<ReactionPass> obstacle_reaction_;
  std::optional<Tools> tools_;
  std::unique_ptr<Blade> blade_;
  std::optional<Recovery> recovery_;
  float largest_spacing_m_ = 0;
  size_t substep_ = 0;          ///< substep with its motions bound
  std::vector<ToolBox> boxes_;  ///< boxes of the tools in this tick
  gpu::ReadbackRing stats_ring_;
};

}  // namespace viscera
