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
#include "solver/gpu/contact/grab_pass.h"
#include "solver/gpu/contact/node_pairs.h"
#include "solver/gpu/contact/node_window.h"
#include "solver/gpu/contact/surroundings_pass.h"
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

/// Of tissue that has springs and lost none the largest rate of its nodes is not 0: where it is, the kernels did not
/// run, or worked on memory that is not there. That looks like tissue at rest, and must not be taken for it.
/// @throws GpuError
void requireSignOfLife(const layout::TickStats& stats);

/// The tissue on the GPU (OpenGL compute).
class GpuBackend final : public SolverBackend {
 public:
  /// @param model  must outlive the backend   @param plan  of model and scene; looked at here only
  /// @throws GpuError  shaders, memory;  SceneError  parts (strengths)
  GpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options = {});

  std::string name() const override { return "gpu"; }
  uint64_t waits() const { return stats_ring_.waits(); }  ///< of the host for measurements, see GpuSolver

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
  void beginSurroundings(const Surroundings& surroundings) override;
  void blow(const Substep& step, const Surroundings& surroundings) override;
  void surround(const Substep& step, const Surroundings& surroundings) override;
  void sumObstacles(const std::vector<Vector3f>& places) override;
  void measure() override;
  void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) override;
  void guard(const Governor::Bounds& bounds, const ToolMotions& motions, double tick_s) override;
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
  struct Tools {  ///< what only a scene with styluses needs
    gpu::Buffer<layout::ToolMotion> motions;
    GrabPass grab;
    CutPass cut;
    ReactionPass reaction;
  };
  struct Blade {  ///< what only tissue that resists blades or is tied to threads needs
    NodeWindow window;
    gpu::Buffer<layout::ToolMotion> sweep;
    gpu::Buffer<layout::vec4> still;  ///< [slots] zero: displacements and velocities of tissue at rest
    uint32_t resists = 0;             ///< bodies that do, a bit each
    size_t body = 0;                  ///< that cutAtRest() cuts
    float kernel_m = 0;               ///< so far from an edge nodes are pushed at most
    bool looked = false;              ///< at nodes, since motions were written
  };
  struct Recovery {  ///< what only a scene with a governor needs
    GoodStates good;
    GuardPass guard;
    std::unique_ptr<Stepper> stepper;  ///< pd without acceleration: every sweep descends; null where a body obeys a law
    std::optional<SlowPass> slow;      ///< only there
  };

  FeatureSet features_;
  LatticeBuffers buffers_;
  std::unique_ptr<NodePairs> pairs_;    ///< null where contacts between nodes are not solved for
  std::unique_ptr<AwakeBricks> awake_;  ///< null where nothing sleeps
  RestWatch rest_;
  std::unique_ptr<Stepper> stepper_;
  MeasurePass measure_;
  const bool has_springs_;  ///< of nodes that may move, in the whole tissue
  bool foreign_ = false;    ///< the state was written in: it may have no springs left
  std::optional<SurroundingsPass> surroundings_;
  std::optional<ReactionPass> obstacle_reaction_;
  std::optional<Tools> tools_;
  std::unique_ptr<Blade> blade_;
  std::optional<Recovery> recovery_;
  float largest_spacing_m_ = 0;
  size_t substep_ = 0;          ///< whose motions are bound
  std::vector<ToolBox> boxes_;  ///< of tools, in this tick
  gpu::ReadbackRing stats_ring_;
};

}  // namespace viscera
