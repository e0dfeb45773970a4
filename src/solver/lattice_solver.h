// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "solver/solver_backend.h"
#include "solver/substeps.h"
#include "solver/watch.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct SolverOptions {
  bool allow_unstable = false;  ///< take a substep that is too long for the integrator: to study the governor
  /// On the CPU: shared with others; null: solver.threads of its own.
  std::shared_ptr<ThreadPool> threads = nullptr;
};

/// What a tick is on any backend: which substeps it has, what tools do in them, what is measured and how the governor
/// judges it (physics.md 2, 3, 5). A backend holds the state and gives the operations; they are called in the order of
/// a tick, and none of them during construction.
class LatticeSolver : public Solver, protected SolverBackend {
 public:
  using Solver::step;
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles) final;
  void reset() final;
  bool pollStats(layout::TickStats& stats, bool wait) final;
  const Health& health() const final;
  double dt_s() const final { return tick_s_ / plan_.calm; }
  double dtSafe_s() const final { return dt_safe_s_; }
  int substeps() const final { return plan_.calm; }
  uint64_t substepsDone() const final { return substeps_done_; }

  /// How long before the displacements the velocities belong [s]: half a substep after leapfrog, else 0. Waits for the
  /// last tick.
  double velocityLag_s();

  /// Sets the state, for tests and saved sessions.
  /// @param staggered  the velocities are those of half a substep earlier, as readState() gives them for leapfrog;
  ///                   otherwise they belong to the same moment as the displacements and time starts anew with a half
  ///                   kick
  void writeState(const HostState& state, bool staggered = false);

 protected:
  /// @param model  must outlive the solver
  /// @throws SceneError  substeps (planSubsteps)
  LatticeSolver(const Model& model, const Scene& scene, const SolverOptions& options);

  // What a backend's own constructor asks.
  bool governed() const { return watch_.has_value(); }
  bool staysAwake() const { return surroundings_ && surroundings_->keepsAwake(); }
  bool hasSurroundings() const { return surroundings_.has_value(); }
  bool hasTools() const { return !acts_.styluses().empty(); }
  double shortestSubstep_s() const { return tick_s_ / plan_.strained; }
  int mostSubsteps() const;  ///< a tick can have
  uint64_t cutRevision() const { return cut_revision_; }

 private:
  Governor newGovernor() const;
  void chooseSubsteps();
  void substep(int index, const ToolMotions& motions, bool cuts, bool contacts);
  void finishStats();
  void keepStats(const layout::TickStats& stats);
  void measureTick(const ToolMotions& motions, bool contacts);
  bool heed(const Watch::Verdict& verdict);
  void relaxSubsteps(const layout::TickStats& stats);

  const Model& model_;
  SolverConfig config_;
  ToolActs acts_;
  Vector3f gravity_;
  double tick_s_, dt_safe_s_, push_speed_m_per_s_;
  SubstepPlan plan_;
  int recovery_substeps_;
  std::optional<Watch> watch_;                ///< only where a scene has a governor
  std::optional<Surroundings> surroundings_;  ///< only where a scene has any
  std::vector<layout::TickStats> finished_;   ///< taken while nobody asked, oldest first
  std::vector<layout::ToolMotion> motions_;
  uint64_t cut_revision_ = 0, substeps_done_ = 0;
  uint32_t springs_cut_ = 0;  ///< when dt_safe was last computed
  int n_ = 1;                 ///< substeps of this tick
  bool recovering_ = false;   ///< in this tick
  bool restarted_ = true;     ///< the next substep starts anew
  double last_dt_s_ = 0;
};

}  // namespace viscera
