// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "solver/contact/environment.h"
#include "solver/contact/tool_port.h"
#include "solver/processes/port.h"
#include "solver/tissue/substep.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/stability_monitor.h"
#include "viscera/solver/state.h"

namespace viscera {

class Archive;

/// Holder of the tissue's state, with the operations that make up a tick. TissueStepper and its RollbackGuard call them
/// in the order of a tick, once the backend is built. What its construction must know is in TickPlan.
class SolverBackend : public ToolPort, public TissuePort {
 public:
  virtual std::string name() const = 0;  ///< name for the user, such as "gpu"

  /// Number of states kept for roll-backs, one per good tick; up to lag() unjudged ticks are kept in addition
  static constexpr int kGoodStates = 4;
  /// Sweeps per substep of a recovery by pd: leads to as many sweeps per tick as leapfrog has substeps.
  static constexpr int kRecoveryIterations = 20;

  /// @name Operations of a tick, besides those of ToolPort and, where tissue resists blades, of TissuePort
  /// @{
  /// Begins a tick: takes back what the backend shares with others, such as OpenGL's bindings.
  virtual void beginTick() = 0;
  /// Writes the motions of all styluses in this tick's substeps, in ticks in which a stylus cuts or touches.
  /// @param motions  [substeps * kMaxStyluses] substep-major; must not change until the tick ends
  virtual void writeMotions(const std::vector<layout::ToolMotion>& motions) = 0;
  /// Selects the motions of a substep of this tick for the following cut() and advance().
  virtual void selectMotions(size_t substep) = 0;
  /// Advances every active node by a substep. The result is the current state.
  /// @param recovery  only with a stability monitor: use pd without acceleration in place of the scene's integrator.
  /// Without TickPlan::recovers_by_pd, use the scene's integrator, then slow the nodes (slowing.h)
  virtual void advance(const Substep& step, bool recovery) = 0;
  /// Passes the environment of the tick that begins. Called only if there are environment.
  virtual void beginEnvironment(const Environment& environment) = 0;
  /// Applies wind and forces to the velocities before an implicit substep. Called only if there are any.
  virtual void blow(const Substep& step, const Environment& environment) = 0;
  /// Applies the environment to the substep that advance() has just made. After an implicit substep these are only the
  /// contacts between nodes: the rest was part of its solution.
  virtual void surround(const Substep& step, const Environment& environment) = 0;
  /// Sums the impulses of obstacles in the tick into the measurements. @param places  [obstacles] positions at its end,
  /// tissue frame [m]
  virtual void sumObstacles(const std::vector<Vector3f>& positions) = 0;
  /// Measures the current state: all of TickStats but the contributions of tools and obstacles, which are cleared.
  virtual void measure() = 0;
  /// Sums the tick's reactions into the measurements, in ticks in which a stylus touches. @param tips  positions in the
  /// tissue frame [m]
  virtual void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) = 0;
  /// Replaces the current state with the last saved one, as restoreGood(0) does, if the measurements exceed the bounds
  /// of the stability monitor (StabilityMonitor::inspect). Called only if there is a lag, and does not wait.
  /// @param motions  motions of the tick   @param tick_s  length of the tick [s]
  virtual void guard(const StabilityMonitor::Bounds& bounds, const ToolMotions& motions, double tick_s) = 0;
  /// @}

  /// @name Transfer of measurements to the host, which may take some ticks on a GPU and is immediate on a CPU
  /// @{
  /// Returns the number of ticks, 0 or 1, after which the stability monitor judges a tick. It is fixed, so results do
  /// not depend on how far the backend is behind. It is 1 where waiting for the tick just made would leave the backend
  /// idle.
  virtual int lag() const = 0;
  /// Starts the transfer of the last measurements. Returns false if the maximum number of transfers is in progress:
  /// take one first.
  virtual bool requestStats() = 0;
  /// Returns in `stats` the oldest measurements in transfer. Returns false if there are none, or none has arrived.
  /// @param wait  wait for the oldest if it is in transfer
  virtual bool takeStats(layout::TickStats& stats, bool wait) = 0;
  /// @}

  /// Returns whether tissue has torn since the last call.
  virtual bool takeTorn() { return false; }

  /// @name State as a whole
  /// @{
  virtual HostState readState() const = 0;  ///< waits for the backend
  /// Takes a snapshot as Solver::snapshot(). @param cut_revision  grows whenever springs may have been cut or the state
  /// was written
  virtual void snapshot(StateSnapshot& out, uint64_t cut_revision) const = 0;
  /// Returns the current cuts, in the format of Solver::readCuts().
  virtual void readCuts(CutSprings& out) const = 0;
  /// Returns the state as Solver::stateOnGpu(). @param cut_revision  as in snapshot()
  virtual std::optional<StateView> stateOnGpu(uint64_t cut_revision) const = 0;
  virtual void resetState() = 0;  ///< resets to rest, with whole springs, nothing held, no impulses
  /// Replaces the state; sums of rounding errors start at 0. measure() may follow immediately.
  virtual void loadState(const HostState& state) = 0;
  /// Saves the current displacements and velocities. Called only with a stability monitor. If there are more than
  /// kGoodStates + lag() states, the oldest is discarded.
  virtual void saveGood() = 0;
  /// Restores the state that was saved `back` saves before the last one (0: the last), or the oldest there is, and
  /// discards the younger ones. At the oldest state velocities are set to zero, as nothing else is left to try.
  /// Impulses are cleared.
  virtual void restoreGood(int back) = 0;
  /// Discards all states that saveGood() saved.
  virtual void clearGood() = 0;
  /// Saves or restores as Solver::persist(). No measurements are in transfer.
  virtual void persist(Archive& archive) = 0;
  /// @}
};

}  // namespace viscera
