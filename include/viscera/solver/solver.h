// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"
#include "viscera/solver/governor.h"
#include "viscera/solver/material.h"
#include "viscera/solver/state.h"
#include "viscera/tools/obstacle_motions.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;
class TissueProcess;
struct StylusPull;

/// The seam between the session and a backend: upload, step, state.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Advances every active node by one tick: substeps() substeps of dt_s() (physics.md 2).
  /// @param obstacles  of the scene, over the tick; empty: they stand where they were last
  virtual void step(const ToolMotions& motions, const ObstacleMotions& obstacles) = 0;
  void step(const ToolMotions& motions) { step(motions, ObstacleMotions{}); }
  /// Back to rest: springs whole, nothing held, time 0.
  virtual void reset() = 0;
  /// Buffers of the state where it is on the GPU; nothing where it is on the host: snapshot() shows it then.
  virtual std::optional<StateView> stateOnGpu() const { return std::nullopt; }
  virtual HostState readState() const = 0;  ///< waits
  /// Does the state live in host memory? Then snapshot() is cheap, and what shows the state works from snapshots.
  bool onHost() const { return !stateOnGpu(); }
  /// Copies what showing the current state takes; see StateSnapshot. A backend on the host makes no memory for it once
  /// `out` has had its size; others do it by way of readState().
  virtual void snapshot(StateSnapshot& out) const;
  /// Brings `out` up to the current state. Costs nothing where no tool may have cut since it was last brought there and
  /// the state was neither reset nor written; else a copy on the CPU, while the GPU is waited for: ask there when
  /// TickStats::springs_cut has changed. Makes no memory once `out` has had its size, except by way of readState().
  /// @returns whether something was copied
  virtual bool readCuts(CutState& out) const;
  /// Measurements of the next tick that has come back, oldest first; false if there is none (yet).
  /// @param wait  wait for the next one if one is under way
  virtual bool pollStats(layout::TickStats& stats, bool wait) = 0;
  virtual const Health& health() const = 0;
  virtual double dt_s() const = 0;  ///< in calm states
  virtual double dtSafe_s() const = 0;
  /// Largest substep that is stable at rest, as measured at the start; dtSafe_s() where that is not done
  /// (solver.measured_limit) [s].
  virtual double dtLimit_s() const { return dtSafe_s(); }
  virtual int substeps() const = 0;           ///< per tick, in calm states
  virtual uint64_t substepsDone() const = 0;  ///< since the solver was made
  /// What lives in the tissue beside its forces: blades that it resists, sutures, clips, burns, blood.
  virtual const std::vector<std::unique_ptr<TissueProcess>>& processes() const;
  /// What a stylus gave processes, such as threads and needles, in the tick that pollStats() was last told of.
  /// @param stylus  < kMaxStyluses
  virtual const StylusPull& pull(uint32_t stylus) const;
  virtual std::string backend() const = 0;
  /// All that the ticks to come depend on, between two ticks, into an archive or out of it: the solver that reads it
  /// was made for the same model and scene, and goes on to the bit like the one that wrote it. Waits.
  /// @throws Error  the archive is another solver's, or this one keeps nothing
  virtual void persist(Archive& archive);
  /// Goes on from a state of the same model. @throws Error  this solver takes none
  virtual void goOnFrom(const HostState& state);
};

/// 64-bit fingerprint of displacement, velocity and springs of the active nodes, in active-list order.
uint64_t stateHash(const Model& model, const HostState& state);

}  // namespace viscera
