// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include "math/archive.h"
#include "solver/processes/port.h"
#include "solver/processes/stylus_pull.h"
#include "viscera/math/state_hash.h"
#include "viscera/solver/facts.h"
#include "viscera/solver/process_visuals.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/state.h"
#include "viscera/tools/obstacle_motions.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What a process does when the stability monitor (stability monitor) restores an older state of the tissue.
enum class RollBack {
  kUndo,     ///< restores its own state of that time too (TissueProcess::persistUndone)
  kKeep,     ///< keeps its state: heat that was given stays given
  kRestart,  ///< restarts at the current state of the tissue (TissueProcess::restart)
};

/// A tick, as processes see it.
struct ProcessTick {
  const ToolMotions& motions;
  const ObstacleMotions& obstacles;  ///< motions of all obstacles of the scene over the tick; empty: they do not move
  int substeps = 1;                  ///< substeps of the tissue
  bool cuts = false;                 ///< some stylus cuts in it
  bool recovering = false;           ///< the stability monitor lets the tissue come to rest: tools do not cut or burn
};

/// The last substep of the tissue.
struct ProcessSubstep {
  int index = 0;
  double dt_s = 0;
  const layout::ToolMotion* tools = nullptr;  ///< [kMaxStyluses]; null if no stylus touches or cuts
};

class TissueProcess;
/// The processes of a scene in the order in which they act.
using TissueProcesses = std::vector<std::unique_ptr<TissueProcess>>;

/// Process in tissue in addition to its forces: blades that it resists, sutures, clips, burns, blood. The registry
/// (registry.h) makes a scene's processes, and TissueStepper runs them, in its order. Calls come in the order of a
/// tick. Most have a default that does nothing.
class TissueProcess {
 public:
  virtual ~TissueProcess() = default;

  virtual RollBack rollBack() const = 0;
  /// Returns whether cutsChanged() is to be called. Reading cuts waits for a GPU.
  virtual bool readsCuts() const { return false; }

  /// @name A tick
  /// @{
  /// Handles cuts: springs were cut, or whole ones restored, since the last call.
  virtual void cutsChanged(const CutSprings&) {}
  virtual void beginTick(const ProcessTick&) {}
  /// Acts after a substep of the tissue. @returns whether springs were cut
  virtual bool act(TissuePort&, const ProcessTick&, const ProcessSubstep&) { return false; }
  /// Acts after the last substep. @param all  processes of the scene, in their order   @returns whether springs were
  /// cut
  virtual bool endTick(TissuePort&, const ProcessTick&, const TissueProcesses& /*all*/) { return false; }
  /// Returns the work done on the tissue in the tick [J], without that of styluses; negative if energy was removed.
  virtual double work_j() const { return 0; }
  /// Returns whether pushNodes() may have named a stylus in the tick: reactions are summed then.
  virtual bool pushesStyluses(const ProcessTick&) const { return false; }
  /// Adds the forces and moments of styluses on the process in the tick.
  virtual void addPulls(StylusPulls&) const {}
  /// @}

  /// @name State
  /// @{
  /// Resets to the initial state of the scene.
  virtual void reset() = 0;
  /// Writes or reads all state that affects later ticks, in one section of its own.
  virtual void persist(Archive& archive) = 0;
  /// Writes or reads the state that a roll-back restores, for RollBack::kUndo.
  virtual void persistUndone(Archive&) {}
  /// Handles that persistUndone() restored an older state. @param at_rest  it is the oldest: nothing moves in it
  virtual void undone(bool /*at_rest*/) {}
  /// Restarts the process, for RollBack::kRestart. @returns whether springs were cut
  virtual bool restart(TissuePort&) { return false; }
  /// Adds its state to the hash of a session. @returns whether it has any: else nothing was added
  virtual bool addTo(StateHash&) const { return false; }
  /// @}

  /// @name Output
  /// @{
  virtual FactGroup facts() const = 0;
  virtual void draw(ProcessVisuals&) const {}
  /// @}
};

/// Returns a hash with the state of a process added.
uint64_t hashWith(uint64_t hash, const TissueProcess& process);

/// Finds a process of a scene by its class. @returns null  the scene has none
template <class Process>
Process* findProcess(const TissueProcesses& processes) {
  static_assert(std::is_base_of_v<TissueProcess, Process>);
  for (const std::unique_ptr<TissueProcess>& process : processes) {
    if (auto* const found = dynamic_cast<Process*>(process.get())) return found;
  }
  return nullptr;
}
template <class Process>
Process* findProcess(const Solver& solver) {
  return findProcess<Process>(solver.processes());
}

}  // namespace viscera
