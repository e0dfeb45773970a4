// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/contact/tool_acts.h"
#include "solver/ticks/process_list.h"
#include "solver/ticks/rollback_guard.h"
#include "solver/ticks/solver_backend.h"
#include "solver/ticks/tick_plan.h"
#include "viscera/solver/solver.h"

namespace viscera {

struct Scene;

/// A tick on any backend: the choice of substeps, the actions of tools in them, the measurements and their judgement by
/// the stability monitor (physics.md 2, 3, 5). The backend holds the state and provides the operations.
class TissueStepper : public Solver {
 public:
  /// @param model  must outlive the solver   @param plan  of model and scene; the backend was built for it
  TissueStepper(const Model& model, const Scene& scene, const TickPlan& plan, std::unique_ptr<SolverBackend> backend);

  using Solver::step;
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles) final;
  void reset() final;
  std::optional<StateView> stateOnGpu() const final { return backend_->stateOnGpu(cut_revision_); }
  HostState readState() const final { return backend_->readState(); }
  void snapshot(StateSnapshot& out) const final { backend_->snapshot(out, cut_revision_); }
  bool readCuts(CutState& out) const final;
  bool pollStats(layout::TickStats& stats, bool wait) final;
  const Health& health() const final;
  double dt_s() const final { return tick_s_ / substeps_.calm; }
  double dtSafe_s() const final { return dt_safe_s_; }
  double dtLimit_s() const final { return dt_limit_s_ > 0 ? dt_limit_s_ : dt_safe_s_; }
  int substeps() const final { return substeps_.calm; }
  uint64_t substepsDone() const final { return substeps_done_; }
  const TissueProcesses& processes() const final { return processes_.all(); }
  const StylusPull& pull(uint32_t stylus) const final { return reported_pulls_[stylus]; }
  void persist(Archive& archive) final;
  void goOnFrom(const HostState& state) final { writeState(state); }
  std::string backend() const final { return backend_->name(); }
  /// Sets the initial state, now and after every reset.
  void startFrom(HostState state);

  /// Returns by how much the velocities are earlier than the displacements [s]: half a substep after leapfrog, else 0.
  /// Waits for the last tick.
  double velocityLag_s();

  /// Sets the state, for tests and saved sessions.
  /// @param staggered  the velocities are half a substep earlier, as readState() returns them for leapfrog. Otherwise
  /// they are of the same time as the displacements, and time integration restarts with a half kick
  void writeState(const HostState& state, bool staggered = false);

 protected:
  /// Returns the backend, for its creator, who knows its type.
  const SolverBackend& ticked() const { return *backend_; }

 private:
  StabilityMonitor newGovernor() const;
  void replan();
  void tellOfCuts();
  void recordStretch(const layout::TickStats& stats);
  bool hasLongSubsteps() const;
  bool stepsByPd() const { return recovering_ && recovers_by_pd_; }
  int calmSubsteps() const;
  void chooseSubsteps();
  void substep(int index, const ProcessTick& tick, bool contacts);
  void writeMotions(const ToolMotions& motions);
  void finishStats();
  bool takeStats(TickFindings& findings, bool wait);
  void keepStats(const TickFindings& findings);
  void measureTick(const ToolMotions& motions, bool contacts);
  bool applyVerdict(const RollbackGuard::Verdict& verdict);
  void relaxSubsteps(const layout::TickStats& stats);
  void persistSubsteps(Archive& archive);

  const Model& model_;
  std::unique_ptr<SolverBackend> backend_;
  SolverConfig config_;
  ToolActs acts_;
  Vector3f gravity_;
  double tick_s_, attached_per_s2_, dt_safe_s_, push_speed_m_per_s_;
  float edge_reach_m_;
  double dt_limit_s_ = 0;  ///< measured at the start [s]; 0: not measured
  double dashpot_ratio_;   ///< largest stiffness_damping_ratio of all bodies
  /// Stiffening of cells of a hyperelastic law: the value that substeps account for, the largest recent one including
  /// the predicted growth; and that of the last good tick.
  double stiffening_ = 0, last_stiffening_ = 0;
  double released_ = 0;  ///< value of releasedStiffening()
  int releasing_ = 0;   ///< ticks, including this one, in which the strain of cells freed by a stylus may be unmeasured
  double stretch_ = 0;  ///< largest stretch of the last good tick, rounded down
  SubstepPlan substeps_;
  int recovery_substeps_, most_substeps_;
  bool uses_stiffening_, recovers_by_pd_;
  std::optional<Environment> environment_;  ///< only where a scene has any
  ProcessList processes_;
  CutState seen_cuts_;                  ///< only where a process reads cuts
  std::vector<StylusPulls> pulls_;      ///< pulls of ticks with measurements in transfer, without a stability monitor
  std::optional<HostState> start_;      ///< start state; none: rest
  std::optional<RollbackGuard> watch_;  ///< only where a scene has a stability monitor
  std::vector<TickFindings> finished_;  ///< findings that arrived before they were requested, oldest first
  StylusPulls reported_pulls_;          ///< pulls of the findings that were returned last
  std::vector<layout::ToolMotion> motions_;
  uint64_t cut_revision_ = 0, substeps_done_ = 0;
  uint32_t springs_cut_ = 0;  ///< springs cut when dt_safe was last computed
  int n_ = 1;                 ///< substeps of this tick
  bool recovering_ = false;   ///< this tick is part of a recovery
  bool restarted_ = true;     ///< the next substep restarts time integration
  double last_dt_s_ = 0;
};

}  // namespace viscera
