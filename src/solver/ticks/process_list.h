// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/process.h"

namespace viscera {

/// The processes of a scene, run as one. TissueStepper and RollbackGuard call them through this list and know none of
/// them.
class ProcessList {
 public:
  /// @param good_states  number of states kept for roll-backs, the same as in SolverBackend
  ProcessList(TissueProcesses processes, size_t good_states);

  const TissueProcesses& all() const { return processes_; }

  /// @name As in TissueProcess, for all processes. Those that report cuts return the number of processes that cut
  /// springs.
  /// @{
  bool readCuts() const;
  void cutsChanged(const CutSprings& cuts);
  void beginTick(const ProcessTick& tick);
  uint64_t act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep);
  uint64_t endTick(TissuePort& port, const ProcessTick& tick);
  bool pushStyluses(const ProcessTick& tick) const;
  StylusPulls pulls() const;
  /// Sums the work of the processes that did positive work, so that work taken away by one does not hide another's.
  double work_j() const;
  void reset();
  /// @}

  /// @name State for roll-backs, as SolverBackend::saveGood(), restoreGood(), clearGood()
  /// @{
  void saveGood();
  void restoreGood(int back);
  void clearGood();
  /// Restarts the processes after the state was restored. @returns  number of processes that cut springs
  uint64_t restart(TissuePort& port);
  /// @}
  void persist(Archive& archive);

 private:
  using States = std::vector<std::vector<Archive::Section>>;
  TissueProcesses processes_;
  std::vector<States> kept_;  ///< [processes] states, oldest first; only those with RollBack::kUndo
  size_t good_states_;
};

}  // namespace viscera
