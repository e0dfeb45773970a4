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
#include "viscera/solver/process_look.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/state.h"
#include "viscera/tools/obstacle_motions.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What a process does when the stability monitor (governor) puts an older state of the tissue back.
enum class RollBack {
  kUndo,     ///< its own state of then is put back too (TissueProcess::persistUndone)
  kKeep,     ///< keeps its state: heat that was given stays given
  kRestart,  ///< begins again where the tissue is now (TissueProcess::restart)
};

/// A tick, as processes see it.
struct ProcessTick {
  const ToolMotions& motions;
  const ObstacleMotions& obstacles;  ///< at the end of each, of all in the scene; empty: they stand still
  int substeps = 1;                  ///< of the tissue
  bool cuts = false;                 ///< some stylus cuts in it
  bool recovering = false;           ///< the stability monitor lets the tissue come to rest: tools do not cut or burn
};

/// A substep that the tissue has just made.
struct ProcessSubstep {
  int index = 0;
  double dt_s = 0;
  const layout::ToolMotion* tools = nullptr;  ///< [kMaxStyluses]; null where no stylus touches or cuts
};

class TissueProcess;
/// The processes of a scene in the order in which they act.
using TissueProcesses = std::vector<std::unique_ptr<TissueProcess>>;

/// Something that lives in tissue beside its forces: blades that it resists, sutures, clips, burns, blood. A scene's
/// processes are made by the registry (registry.h) and run by Ticks, in its order. Calls come in the order of a tick;
/// each has a default that does nothing.
class TissueProcess {
 public:
  virtual ~TissueProcess() = default;

  virtual RollBack rollBack() const = 0;
  /// Whether cutsChanged() is to be called. Reading cuts waits for a GPU.
  virtual bool readsCuts() const { return false; }

  /// @name A tick
  /// @{
  /// Springs were cut, or whole ones put back, since the last call.
  virtual void cutsChanged(const CutSprings&) {}
  virtual void beginTick(const ProcessTick&) {}
  /// Acts after a substep of the tissue. @returns whether springs were cut
  virtual bool act(TissuePort&, const ProcessTick&, const ProcessSubstep&) { return false; }
  /// Acts after the last substep. @param all  of the scene, in their order   @returns whether springs were cut
  virtual bool endTick(TissuePort&, const ProcessTick&, const TissueProcesses& /*all*/) { return false; }
  /// @returns  work done on the tissue in the tick [J], beside that of styluses; what it took away is below 0
  virtual double work_j() const { return 0; }
  /// Whether pushNodes() may have named a stylus in the tick: reactions are summed then.
  virtual bool pushesStyluses(const ProcessTick&) const { return false; }
  /// Adds what styluses gave the process in the tick.
  virtual void addPulls(StylusPulls&) const {}
  /// @}

  /// @name State
  /// @{
  /// Goes back to what the scene starts with.
  virtual void reset() = 0;
  /// Writes or reads all that the ticks to come depend on, in one section of its own.
  virtual void persist(Archive& archive) = 0;
  /// Writes or reads what a roll-back puts back, for RollBack::kUndo.
  virtual void persistUndone(Archive&) {}
  /// An older state was put back by persistUndone(). @param at_rest  it is the oldest: nothing moves in it
  virtual void undone(bool /*at_rest*/) {}
  /// Begins again, for RollBack::kRestart. @returns whether springs were cut
  virtual bool restart(TissuePort&) { return false; }
  /// Adds its state to the fingerprint of a session. @returns whether it has any: else nothing was added
  virtual bool addTo(StateHash&) const { return false; }
  /// @}

  /// @name What others see
  /// @{
  virtual FactGroup facts() const = 0;
  virtual void draw(ProcessLook&) const {}
  /// @}
};

/// @returns  a fingerprint with the state of a process added
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
