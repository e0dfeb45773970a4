// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "solver/ticks/process_list.h"
#include "solver/ticks/solver_backend.h"
#include "viscera/solver/stability_monitor.h"

namespace viscera {

class Archive;

/// Published findings of a tick: its measurements, and in addition what styluses gave processes, such as needles.
struct TickFindings {
  layout::TickStats stats{};
  StylusPulls pulls;
};

/// Applies the verdicts of the stability monitor to a scene's ticks (physics.md 3). A tick is open from its end until
/// its measurements are judged, immediately or, where the backend lags, after the next tick. Good states are saved, bad
/// ticks are rolled back, and measurements of bad ticks are not published.
class RollbackGuard {
 public:
  /// Result of judging a tick, for the code that makes the ticks.
  struct Verdict {
    std::optional<TickFindings> published;  ///< findings that were not requested yet
    std::optional<layout::TickStats> good;  ///< unmodified measurements of the tick, if it was good
    bool rolled_back = false;  ///< the state was replaced by an older one: the next substep restarts time integration
  };

  /// @param backend  must outlive this   @param may_be_fast  the scene's integrator permits fast nodes
  /// @param tick_s  length of a tick [s]
  /// @param processes  of the scene; their states are rolled back as they specify; must outlive this
  RollbackGuard(SolverBackend& backend, const StabilityMonitor& stability_monitor, bool may_be_fast, double tick_s,
                ProcessList& processes);

  /// Returns the number of consecutive roll-backs.
  int setbacks() const { return stability_monitor_.setbacks(); }
  /// Returns the health as the stability monitor reports it: one tick less than were made while one is open.
  const Health& health() const { return stability_monitor_.health(); }

  /// Lets the backend itself stop a bad tick if the monitor would judge it only later. Call after its measurements.
  /// @param recovering  the tick was part of a recovery
  void guard(const ToolMotions& motions, bool recovering);
  /// Ends a tick with measurements in transfer: saves its state if it is good or may be.
  /// @param undone  the previous tick was bad and rolled back: this one does not count
  /// @param long_substeps  its substeps were longer than the proven ones (StabilityMonitor::judge)
  Verdict endTick(const ToolMotions& motions, bool recovering, bool undone, bool long_substeps);
  /// Judges and closes the open tick, if any, and rolls it back if it was bad. Waits for measurements.
  Verdict judgeOpen();
  /// Returns whether the open tick will be rolled back or does not count; false if none is open. Waits for its
  /// measurements.
  bool openIsBad();
  /// Returns the findings of the open tick, once. @param wait  for its measurements if they are in transfer
  bool poll(TickFindings& findings, bool wait);

  /// Restarts from a current state that was written from outside, with no tick open: it is measured and becomes the
  /// only good state.
  /// @return the measurements
  const layout::TickStats& restart();
  /// Resets to the current state, which is that of rest: no tick is open, and it is the only good state.
  void reset(const StabilityMonitor& stability_monitor);
  /// Saves or restores. The measurements of the open tick have been requested.
  void persist(Archive& archive);

 private:
  /// A tick that is not judged yet.
  struct OpenTick {
    ToolMotions motions;
    bool recovering = false;
    bool undone = false;  ///< the previous tick was bad: this one does not count
    bool long_substeps = false;
    bool delivered = false;  ///< whether its measurements were returned
    StylusPulls pulls;       ///< pulls, in addition to the measurements
    double processes_j = 0;  ///< work of the processes on the tissue [J]
    std::optional<layout::TickStats> stats;
  };
  bool receive(bool wait);
  bool isBad() const;
  TickFindings published() const;
  bool mayBeFast(bool recovering) const { return recovering || may_be_fast_; }
  double workOn(const OpenTick& tick) const;
  void saveGood();
  void keepOnlyCurrent();

  SolverBackend& backend_;
  StabilityMonitor stability_monitor_;
  bool may_be_fast_;
  double tick_s_;
  ProcessList& processes_;
  layout::TickStats last_good_{};
  std::optional<OpenTick> open_;
};

}  // namespace viscera
