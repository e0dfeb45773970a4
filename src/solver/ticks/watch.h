// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "solver/ticks/process_list.h"
#include "solver/ticks/solver_backend.h"
#include "viscera/solver/governor.h"

namespace viscera {

class Archive;

/// What others are told of a tick: measurements, and of them what styluses gave processes, such as needles.
struct TickFindings {
  layout::TickStats stats{};
  StylusPulls pulls;
};

/// Carries out what a governor says of a scene's ticks (physics.md 3): a tick is open from its end until its
/// measurements are judged, at once or, where the backend lags, after the tick that follows. Good states are kept, bad
/// ticks are rolled back, and what was bad is not told.
class Watch {
 public:
  /// What follows from having judged a tick, for what makes the ticks.
  struct Verdict {
    std::optional<TickFindings> published;  ///< not asked for yet
    std::optional<layout::TickStats> good;  ///< of the tick, as they are, if it was good
    bool rolled_back = false;               ///< the state is an older one: the next substep starts again
  };

  /// @param backend  must outlive this   @param may_be_fast  with the scene's integrator   @param tick_s  length
  /// @param processes  of the scene, whose states go back as they say; must outlive this
  Watch(SolverBackend& backend, const Governor& governor, bool may_be_fast, double tick_s, ProcessList& processes);

  /// As the governor has it: with one tick less than were made while one is open.
  /// Roll-backs in a row.
  int setbacks() const { return governor_.setbacks(); }
  const Health& health() const { return governor_.health(); }

  /// Has the backend itself stop a bad tick where the governor would see it only later. After its measurements.
  /// @param recovering  the tick was one of a recovery
  void guard(const ToolMotions& motions, bool recovering);
  /// Ends a tick whose measurements are on their way: keeps its state if it is good or may be.
  /// @param undone  the tick before was not, and was rolled back: this one does not count
  /// @param long_substeps  it had substeps longer than proven ones (Governor::judge)
  Verdict endTick(const ToolMotions& motions, bool recovering, bool undone, bool long_substeps);
  /// Judges the tick that is open, if any, and closes it; rolls it back where it was bad. Waits for measurements.
  Verdict judgeOpen();
  /// Will the open tick be rolled back, or does it not count? False if none is open. Waits for its measurements.
  bool openIsBad();
  /// Of the open tick, once. @param wait  for its measurements if they are under way
  bool poll(TickFindings& findings, bool wait);

  /// The current state was written from outside, with no tick open: it is measured, and the only good one.
  /// @return what was measured
  const layout::TickStats& restart();
  /// The current state is that of rest: no tick is open, and it is the only good one.
  void reset(const Governor& governor);
  /// The measurements of the open tick were asked for.
  void persist(Archive& archive);

 private:
  /// A tick that is still to be judged.
  struct OpenTick {
    ToolMotions motions;
    bool recovering = false;
    bool undone = false;  ///< the tick before was bad: this one does not count
    bool long_substeps = false;
    bool delivered = false;  ///< its measurements were asked for already
    StylusPulls pulls;       ///< in addition to what is measured
    double processes_j = 0;  ///< their work on the tissue
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
  Governor governor_;
  bool may_be_fast_;
  double tick_s_;
  ProcessList& processes_;
  layout::TickStats last_good_{};
  std::optional<OpenTick> open_;
};

}  // namespace viscera
