// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/process.h"

namespace viscera {

/// The processes of a scene, run as one: Ticks and Watch go through them here, and know none of them.
class ProcessList {
 public:
  /// @param good_states  how many are kept for roll-backs, as SolverBackend keeps them
  ProcessList(TissueProcesses processes, size_t good_states);

  const TissueProcesses& all() const { return processes_; }

  /// @name As in TissueProcess, of all. Those that say whether springs were cut return how many processes cut some.
  /// @{
  bool readCuts() const;
  void cutsChanged(const CutSprings& cuts);
  void beginTick(const ProcessTick& tick);
  uint64_t act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep);
  uint64_t endTick(TissuePort& port, const ProcessTick& tick);
  bool pushStyluses(const ProcessTick& tick) const;
  StylusPulls pulls() const;
  /// Sums the work of those that did some: what one took away does not hide what another did.
  double work_j() const;
  void reset();
  /// @}

  /// @name What roll-backs put back: as SolverBackend::saveGood(), restoreGood(), clearGood()
  /// @{
  void saveGood();
  void restoreGood(int back);
  void clearGood();
  /// After the state was put back. @returns  how many cut springs
  uint64_t restart(TissuePort& port);
  /// @}
  void persist(Archive& archive);

 private:
  using States = std::vector<std::vector<Archive::Section>>;
  TissueProcesses processes_;
  std::vector<States> kept_;  ///< [processes] oldest first; of RollBack::kUndo only
  size_t good_states_;
};

}  // namespace viscera
