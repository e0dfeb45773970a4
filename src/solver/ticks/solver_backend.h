// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "solver/contact/surroundings.h"
#include "solver/contact/tool_target.h"
#include "solver/processes/port.h"
#include "solver/tissue/substep.h"
#include "viscera/solver/governor.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/state.h"

namespace viscera {

class Archive;

/// What holds the state of the tissue and gives the operations of which a tick is made. They are called in the order
/// of a tick by Ticks and its Watch, once it is built: what a backend's construction must know is in TickPlan.
class SolverBackend : public ToolTarget, public TissuePort {
 public:
  virtual std::string name() const = 0;  ///< for a person, such as "gpu"

  /// States that are kept for rollbacks, one per good tick; with them those of lag() ticks not judged yet.
  static constexpr int kGoodStates = 4;
  /// Sweeps per substep of a recovery by pd: as many in a tick as leapfrog has substeps.
  static constexpr int kRecoveryIterations = 20;

  /// @name Operations of a tick, besides those of ToolTarget and, where tissue resists blades, of TissuePort
  /// @{
  /// Before the first of them: what the backend shares with others, such as OpenGL's bindings, is its own again.
  virtual void beginTick() = 0;
  /// Motions of all styluses in this tick's substeps, in ticks in which one cuts or touches.
  /// @param motions  [substeps * kMaxStyluses] substep-major; stays as it is until the tick ends
  virtual void writeMotions(const std::vector<layout::ToolMotion>& motions) = 0;
  /// From now on cut() and advance() see the motions of this substep of the tick.
  virtual void selectMotions(size_t substep) = 0;
  /// Advances every active node by a substep; the result is the current state.
  /// @param recovery  only where there is a governor: pd without acceleration instead of the scene's integrator, or,
  /// without TickPlan::recovers_by_pd, the scene's, after which nodes are slowed (slowing.h)
  virtual void advance(const Substep& step, bool recovery) = 0;
  /// Tells of the tick that begins, only where there are surroundings.
  virtual void beginSurroundings(const Surroundings& surroundings) = 0;
  /// Before an implicit substep: wind and forces give the velocities what they give in it. Only where there are any.
  virtual void blow(const Substep& step, const Surroundings& surroundings) = 0;
  /// What surrounds the tissue acts on the substep that advance() has just made; of an implicit one contacts between
  /// nodes only: the rest was part of it.
  virtual void surround(const Substep& step, const Surroundings& surroundings) = 0;
  /// Sums what obstacles gave in the tick into measurements. @param places  [obstacles] at its end, tissue frame [m]
  virtual void sumObstacles(const std::vector<Vector3f>& places) = 0;
  /// Measures the current state: all of TickStats but what tools and obstacles gave; that is cleared.
  virtual void measure() = 0;
  /// Sums the tick's reactions into the measurements, in ticks in which a stylus touches. @param tips  tissue frame [m]
  virtual void sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) = 0;
  /// Where the measurements exceed what the governor lets pass (Governor::inspect), puts the state that was saved last
  /// in the place of the current one, as restoreGood(0) does. Only where there is a lag, and so that nothing need wait.
  /// @param motions  of the tick   @param tick_s  its length
  virtual void guard(const Governor::Bounds& bounds, const ToolMotions& motions, double tick_s) = 0;
  /// @}

  /// @name Measurements on their way to the host, which may take some ticks on a GPU and is at once on a CPU
  /// @{
  /// Ticks, 0 or 1, after which the governor judges a tick. A fixed number, so that what follows does not depend on how
  /// far the backend is behind; 1 where waiting for the tick just made would leave the backend without work.
  virtual int lag() const = 0;
  /// Sends the measurements made last on their way. False if as many as may be are under way already: take one first.
  virtual bool requestStats() = 0;
  /// Hands over the oldest of those under way. False if there is none, or none is there yet.
  /// @param wait  for the oldest, if it is under way
  virtual bool takeStats(layout::TickStats& stats, bool wait) = 0;
  /// @}

  /// Has tissue torn since it was asked last?
  virtual bool takeTorn() { return false; }

  /// @name State as a whole
  /// @{
  virtual HostState readState() const = 0;  ///< waits
  /// As Solver::snapshot(). @param cut_revision  grows whenever springs may have been cut or the state was written
  virtual void snapshot(StateSnapshot& out, uint64_t cut_revision) const = 0;
  /// As they are now, as Solver::readCuts() hands them out.
  virtual void readCuts(CutSprings& out) const = 0;
  /// As Solver::stateOnGpu(). @param cut_revision  as in snapshot()
  virtual std::optional<StateView> stateOnGpu(uint64_t cut_revision) const = 0;
  virtual void resetState() = 0;  ///< rest, whole springs, nothing held, no impulses
  /// Takes the state over; sums of rounding errors start at 0. measure() may follow at once.
  virtual void loadState(const HostState& state) = 0;
  /// Keeps the current displacements and velocities, only where there is a governor. Of more than kGoodStates + lag()
  /// the oldest is forgotten.
  virtual void saveGood() = 0;
  /// Puts back the state saved `back` saves before the last one (0: the last), or the oldest there is, and forgets the
  /// younger ones. At the oldest, velocities are put to zero: nothing else is left to try. Impulses are cleared.
  virtual void restoreGood(int back) = 0;
  /// Forgets all that saveGood() kept.
  virtual void clearGood() = 0;
  /// Solver::persist(). No measurements are under way.
  virtual void persist(Archive& archive) = 0;
  /// @}
};

}  // namespace viscera
