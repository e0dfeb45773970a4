// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solver/cpu/kernels/tearing.h"
#include "solver/cpu/kernels/tool_passes.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "solver/cpu/state/cpu_stepper.h"
#include "solver/cpu/state/good_states.h"
#include "solver/cpu/state/sleep.h"
#include "solver/cpu/state/thread_pool.h"
#include "solver/cpu/steps/environment.h"
#include "solver/ticks/solver_backend.h"
#include "solver/ticks/tick_plan.h"

namespace viscera {

struct Scene;

class CpuNetwork;

struct CpuSolverOptions : SolverOptions {
  std::string simd;  ///< one of simdTargets(); empty: the best of this processor
};

/// Returns the instruction sets for which kernels were compiled and that this processor has, best first, such as AVX3,
/// AVX2, SSE4.
std::vector<std::string> simdTargets();

/// Returns the kernels of an instruction set; if empty, of the best one.
/// @throws SceneError  this processor or this build has none of that name
simd::Kernels kernelsOrThrow(const std::string& target);

/// The tissue in host memory, stepped by SIMD threads. Bricks at rest sleep.
class CpuBackend : public SolverBackend {
 public:
  /// @param model  must outlive the backend
  /// @param plan  of model and scene; used only during construction
  /// @throws SceneError  parts (strengths), unknown simd
  CpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const CpuSolverOptions& options = {});
  ~CpuBackend() override;

  std::string name() const override;   ///< such as "cpu (AVX3, 2 threads)"
  size_t awakeBricks() const;          ///< in the last substep
  std::vector<uint8_t> awake() const;  ///< [bricks] 1 where awake
  size_t bricks() const { return lattice_.brickCount(); }

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
  void readRuns(const std::vector<uint32_t>& runs, RunPlanes& u_m, RunPlanes& v_m_per_s) const override;
  void pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs, const RunPlanes& dv_m_per_s) override;
  void selectBody(size_t body) override { selected_body_ = body; }
  void cutAtRest(const layout::ToolMotion& sweep, bool particles) override;
  void advance(const Substep& step, bool recovery) override;
  void beginEnvironment(const Environment& /*environment*/) override {}
  void blow(const Substep& step, const Environment& environment) override;
  void surround(const Substep& step, const Environment& environment) override;
  void sumObstacles(const std::vector<Vector3f>& positions) override;
  void measure() override;
  void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) override;
  void guard(const StabilityMonitor::Bounds& /*bounds*/, const ToolMotions& /*motions*/, double /*tick_s*/) override {}
  bool takeTorn() override { return std::exchange(torn_, false); }
  int lag() const override { return 0; }
  bool requestStats() override;
  bool takeStats(layout::TickStats& stats, bool wait) override;
  HostState readState() const override;
  void snapshot(StateSnapshot& out, uint64_t cut_revision) const override;
  void readCuts(CutSprings& out) const override { lattice_.readCuts(out); }
  std::optional<StateView> stateOnGpu(uint64_t /*cut_revision*/) const override { return std::nullopt; }
  void resetState() override;
  void loadState(const HostState& state) override;
  void saveGood() final;  // final, as construction saves the first state
  void restoreGood(int back) override;
  void clearGood() override;
  void persist(Archive& archive) override;

 private:
  struct Work;  // jobs of the kernels, known only in src/solver/cpu
  void cutWith(const layout::ToolMotion& motion, bool particles, const uint8_t* spared, bool at_rest);
  void sumPushes();
  void wakeForTools(const std::vector<layout::ToolMotion>& motions);
  void changeAll();
  void recordHeld();
  void slow(const Substep& step);
  void measureWalls(const std::vector<uint32_t>& bricks);
  void tear();
  float largestRate() const;

  SolverConfig config_;
  simd::Kernels kernels_;
  FeatureSet features_;
  std::vector<layout::BodyParams> params_;
  CpuLattice lattice_;
  std::shared_ptr<ThreadPool> threads_;
  const ThreadPool& pool_;
  Sleep sleep_;
  std::unique_ptr<Work> work_;
  std::optional<CpuEnvironment> environment_;
  std::unique_ptr<CpuNodePairs> pairs_;  ///< null if contacts between nodes are not part of the solution
  std::unique_ptr<CpuStepper> stepper_;
  std::unique_ptr<CpuStepper> recovery_;     ///< pd; only with a stability monitor and without bodies with a law
  std::vector<layout::ToolMotion> motions_;  ///< of this tick
  const layout::ToolMotion* motion_ = nullptr;
  std::optional<CpuCut> cut_;
  AlignedVector<float> still_[2];  ///< [3 * slots] 0; empty until a blade has cut at rest
  std::vector<uint8_t> resists_;   ///< [bodies] 1: resists blades (cuts take work); empty if none does
  std::vector<uint8_t> others_;    ///< [bodies] 0: the selected one
  std::array<AlignedVector<float>, layout::kMaxStyluses> pushed_;  ///< [3 * slots] N s, impulses of blades in this tick
  std::vector<uint8_t> pushed_bricks_;                             ///< [bricks] 1: pushed by the last push
  size_t selected_body_ = 0;
  std::optional<CpuTearing> tearing_;
  bool torn_ = false;                    ///< since takeTorn()
  std::unique_ptr<CpuNetwork> network_;  ///< null where no body has explicit connections
  layout::TickStats stats_{};
  bool has_stats_ = false;
  uint32_t springs_cut_ = 0, rate_springs_cut_ = 0;

  CpuGoodStates good_;
};

}  // namespace viscera
