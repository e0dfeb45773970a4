// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"
#include "viscera/solver/material.h"
#include "viscera/solver/stability_monitor.h"
#include "viscera/solver/state.h"
#include "viscera/tools/obstacle_motions.h"
#include "viscera/tools/stylus.h"

namespace viscera {  // internal
class Archive;
class TissueProcess;
struct StylusPull;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

/// Interface between the session and a backend: upload, step, state.
class VISCERA_PUBLIC Solver {
 public:
  virtual ~Solver() = default;
  /// Advances every active node by one tick: substeps() substeps of dt_s() (physics.md 2).
  /// @param obstacles  obstacles of the scene over the tick; empty: they stay where they were last
  virtual void step(const ToolMotions& motions, const ObstacleMotions& obstacles) = 0;
  void step(const ToolMotions& motions) { step(motions, ObstacleMotions{}); }
  /// Returns to rest: springs whole, nothing held, time 0.
  virtual void reset() = 0;
  /// Returns the buffers of the state if it is on the GPU; nothing if it is on the host: snapshot() then copies it.
  virtual std::optional<StateView> stateOnGpu() const { return std::nullopt; }
  virtual HostState readState() const = 0;  ///< waits for the last tick
  /// Returns whether the state is in host memory. Then snapshot() is cheap, and display works from snapshots.
  bool onHost() const { return !stateOnGpu(); }
  /// Copies what the display of the current state needs; see StateSnapshot. A backend on the host allocates no memory
  /// once `out` has had its size; others use readState().
  virtual void snapshot(StateSnapshot& out) const;
  /// Updates `out` to the current state. It costs nothing if no tool can have cut since the last update and the state
  /// was neither reset nor written. Otherwise it costs a copy on the CPU and, on the GPU, a wait: call it there only
  /// when TickStats::springs_cut has changed. Allocates no memory once `out` has had its size, except through
  /// readState().
  /// @returns whether something was copied
  virtual bool readCuts(CutState& out) const;
  /// Returns the measurements of the next tick that has come back, oldest first; false if there is none (yet).
  /// @param wait  wait for the next one if one is in flight
  virtual bool pollStats(layout::TickStats& stats, bool wait) = 0;
  virtual const Health& health() const = 0;
  virtual double dt_s() const = 0;  ///< length of a substep in calm states [s]
  virtual double dtSafe_s() const = 0;
  /// Returns the largest substep [s] that is stable at rest, as measured at the start; dtSafe_s() where it was not
  /// measured (solver.measured_limit).
  virtual double dtLimit_s() const { return dtSafe_s(); }
  virtual int substeps() const = 0;           ///< number of substeps per tick, in calm states
  virtual uint64_t substepsDone() const = 0;  ///< number of substeps since the solver was made
  /// Returns the processes in the tissue besides its own forces: blades that it resists, sutures, clips, burns, blood.
  virtual const std::vector<std::unique_ptr<TissueProcess>>& processes() const;
  /// Returns the impulse and moment of a stylus on processes such as sutures and needles, in the last tick that
  /// pollStats() returned.
  /// @param stylus  < kMaxStyluses
  virtual const StylusPull& pull(uint32_t stylus) const;
  virtual std::string backend() const = 0;
  /// Writes to an archive, or reads from it, all that later ticks depend on, between two ticks. The solver that reads
  /// was made for the same model and scene and continues to the bit like the one that wrote. Waits for the last tick.
  /// @throws Error  the archive is another solver's, or this one does not support it
  virtual void persist(Archive& archive);
  /// Continues from a state of the same model. @throws Error  this solver does not support it
  virtual void goOnFrom(const HostState& state);
};

/// Returns a 64-bit fingerprint of displacement, velocity and springs of the active nodes, in active-list order.
uint64_t stateHash(const Model& model, const HostState& state);

}  // namespace viscera
