// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "solver/substep.h"
#include "solver/substeps.h"
#include "solver/surroundings.h"
#include "solver/tool_acts.h"
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
class LatticeSolver : public Solver, protected ToolTarget {
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
  /// States that are kept for rollbacks, one per good tick; with them those of lag() ticks that nobody has judged.
  static constexpr int kGoodStates = 4;
  /// Sweeps per substep of a recovery: as many in a tick as leapfrog has substeps.
  static constexpr int kRecoveryIterations = 20;

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

  /// @name Operations of a tick, besides those of ToolTarget
  /// @{
  /// Before the first of them: what the backend shares with others, such as OpenGL's bindings, is its own again.
  virtual void beginTick() {}
  /// Motions of all styluses in this tick's substeps, in ticks in which one cuts or touches.
  /// @param motions  [substeps * kMaxStyluses] substep-major; stays as it is until the tick ends
  virtual void writeMotions(const std::vector<layout::ToolMotion>& motions) = 0;
  /// From now on cut() and advance() see the motions of this substep of the tick.
  virtual void selectMotions(size_t substep) = 0;
  /// Advances every active node by a substep; the result is the current state.
  /// @param recovery  pd without acceleration instead of the scene's integrator; only where there is a governor
  virtual void advance(const Substep& step, bool recovery) = 0;
  /// Tells of the tick that begins, only where there are surroundings.
  virtual void beginSurroundings(const Surroundings& /*surroundings*/) {}
  /// What surrounds the tissue acts on the substep that advance() has just made.
  virtual void surround(const Substep& step, const Surroundings& surroundings) = 0;
  /// Measures the current state: all of TickStats but impulse, angular and touched; these are cleared.
  virtual void measure() = 0;
  /// Sums the tick's reactions into the measurements, in ticks in which a stylus touches. @param tips  tissue frame [m]
  virtual void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) = 0;
  /// Where the measurements exceed what the governor lets pass (Governor::inspect), puts the state that was saved last
  /// in the place of the current one, as restoreGood(0) does. Only where there is a lag, and so that nobody need wait.
  /// @param motions  of the tick   @param tick_s  its length
  virtual void guard(const Governor::Bounds& /*bounds*/, const ToolMotions& /*motions*/, double /*tick_s*/) {}
  /// @}

  /// @name Measurements on their way to the host, which may take some ticks on a GPU and is at once on a CPU
  /// @{
  /// Ticks, 0 or 1, after which the governor judges a tick. A fixed number, so that what follows does not depend on how
  /// far the backend is behind; 1 where waiting for the tick just made would leave the backend without work.
  virtual int lag() const { return 0; }
  /// Sends the measurements made last on their way. False if as many as may be are under way already: take one first.
  virtual bool requestStats() = 0;
  /// Hands over the oldest of those under way. False if there is none, or none is there yet.
  /// @param wait  for the oldest, if it is under way
  virtual bool takeStats(layout::TickStats& stats, bool wait) = 0;
  /// @}

  /// @name State as a whole
  /// @{
  virtual void resetState() = 0;  ///< rest, whole springs, nothing held, no impulses
  /// Takes the state over; sums of rounding errors start at 0. measure() may follow at once.
  virtual void loadState(const HostState& state) = 0;
  /// Keeps the current displacements and velocities, only where there is a governor. Of more than kGoodStates + lag()
  /// the oldest is forgotten.
  virtual void saveGood() = 0;
  /// Puts back the state saved `back` saves before the last one (0: the last), or the oldest there is, and forgets the
  /// younger ones. At the oldest, velocities are put to zero: nothing else is left to try. Impulses are cleared.
  virtual void restoreGood(int back) = 0;
  virtual void clearGood() = 0;  ///< forgets all that saveGood() kept
                                 /// @}

 private:
  /// A tick that is still to be judged.
  struct OpenTick {
    ToolMotions motions;
    bool recovering = false;
    bool undone = false;     ///< the tick before was bad: this one does not count
    bool delivered = false;  ///< somebody has asked for its measurements already
    std::optional<layout::TickStats> stats;
  };
  struct Watch {  ///< what only a scene with a governor needs
    Governor governor;
    int recovery_substeps;
    layout::TickStats last_good;
    std::optional<OpenTick> open;
  };
  Governor newGovernor() const;
  void chooseSubsteps();
  void substep(int index, const ToolMotions& motions, bool cuts, bool contacts);
  void finishStats();
  void keepStats(const layout::TickStats& stats);
  void measureTick(const ToolMotions& motions, bool contacts);
  void govern(const ToolMotions& motions, bool undone);
  bool receiveOpen(bool wait);
  bool openIsBad() const;
  layout::TickStats publishedOfOpen() const;
  bool judgeOpen();
  bool isImplicit(bool recovering) const { return recovering || !traitsOf(config_.integrator).is_explicit; }
  void relaxSubsteps(const layout::TickStats& stats);

  const Model& model_;
  SolverConfig config_;
  ToolActs acts_;
  Vector3f gravity_;
  double tick_s_, dt_safe_s_, push_speed_m_per_s_;
  SubstepPlan plan_;
  std::optional<Watch> watch_;
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
