// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/contact/tool_acts.h"
#include "solver/ticks/process_list.h"
#include "solver/ticks/solver_backend.h"
#include "solver/ticks/tick_plan.h"
#include "solver/ticks/watch.h"
#include "viscera/solver/solver.h"

namespace viscera {

struct Scene;

/// What a tick is on any backend: which substeps it has, what tools do in them, what is measured and how the governor
/// judges it (physics.md 2, 3, 5). The backend holds the state and gives the operations.
class Ticks : public Solver {
 public:
  /// @param model  must outlive the solver   @param plan  of model and scene, for which the backend was built
  Ticks(const Model& model, const Scene& scene, const TickPlan& plan, std::unique_ptr<SolverBackend> backend);

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
  const StylusPull& pull(uint32_t stylus) const final { return told_[stylus]; }
  void persist(Archive& archive) final;
  void goOnFrom(const HostState& state) final { writeState(state); }
  std::string backend() const final { return backend_->name(); }
  /// The state that it begins in, now and after every reset.
  void startFrom(HostState state);

  /// How long before the displacements the velocities belong [s]: half a substep after leapfrog, else 0. Waits for the
  /// last tick.
  double velocityLag_s();

  /// Sets the state, for tests and saved sessions.
  /// @param staggered  the velocities are those of half a substep earlier, as readState() gives them for leapfrog;
  ///                   otherwise they belong to the same moment as the displacements and time starts again with a half
  ///                   kick
  void writeState(const HostState& state, bool staggered = false);

 protected:
  /// The backend, for who made it and knows of what kind it is.
  const SolverBackend& ticked() const { return *backend_; }

 private:
  Governor newGovernor() const;
  void planAnew();
  void tellOfCuts();
  void noteStretch(const layout::TickStats& stats);
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
  bool heed(const Watch::Verdict& verdict);
  void relaxSubsteps(const layout::TickStats& stats);
  void persistSubsteps(Archive& archive);

  const Model& model_;
  std::unique_ptr<SolverBackend> backend_;
  SolverConfig config_;
  ToolActs acts_;
  Vector3f gravity_;
  double tick_s_, dt_safe_s_, push_speed_m_per_s_;
  float edge_reach_m_;
  double dt_limit_s_ = 0;  ///< measured at the start; 0 where it is not
  double dashpot_ratio_;   ///< the largest
  /// Of cells of a hyperelastic law: what substeps heed, the largest of late and what is to be feared, and that of the
  /// last good tick.
  double stiffening_ = 0, last_stiffening_ = 0;
  double released_ = 0;  ///< releasedStiffening()
  int releasing_ = 0;    ///< ticks in which cells that a stylus lets go may be strained unseen, this one too
  double stretch_ = 0;   ///< largest of the last good tick, rounded down
  SubstepPlan substeps_;
  int recovery_substeps_, most_substeps_;
  bool heeds_stiffening_, recovers_by_pd_;
  std::optional<Surroundings> surroundings_;  ///< only where a scene has any
  ProcessList processes_;
  CutState seen_cuts_;                  ///< only where a process reads cuts
  std::vector<StylusPulls> pulls_;      ///< without a governor: of ticks whose measurements are under way
  std::optional<HostState> start_;      ///< nothing: rest
  std::optional<Watch> watch_;          ///< only where a scene has a governor
  std::vector<TickFindings> finished_;  ///< taken while not asked for, oldest first
  StylusPulls told_;                    ///< of what was asked for last
  std::vector<layout::ToolMotion> motions_;
  uint64_t cut_revision_ = 0, substeps_done_ = 0;
  uint32_t springs_cut_ = 0;  ///< when dt_safe was last computed
  int n_ = 1;                 ///< substeps of this tick
  bool recovering_ = false;   ///< in this tick
  bool restarted_ = true;     ///< the next substep starts again
  double last_dt_s_ = 0;
};

}  // namespace viscera
