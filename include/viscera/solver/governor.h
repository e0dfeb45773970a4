// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"

namespace viscera {

/// |L - l0| / l0 beyond which a tick is strained: the shorter substep that is proven for any state follows, unless the
/// limit was measured and nothing else is wrong. Chosen by `viscera bench stability` (docs/stability.md).
constexpr double kStrainedStretch = 1.0;

/// How a session fares: what the governor has seen and done since the last reset. On the GPU it has not yet seen the
/// last tick.
struct Health {
  uint64_t trips = 0;       ///< ticks that were rolled back
  bool recovering = false;  ///< the tissue descends towards rest (physics.md 3); no force is given
  bool strained = false;    ///< the state calls for a shorter substep
  bool only_long = false;   ///< it does so by long springs alone, and no tool is at the tissue
  double kinetic_j = 0;     ///< energies of the last tick
  double elastic_j = 0;
};

/// The governor's judgement of ticks (physics.md 3). Host logic only: Watch does what it says.
class Governor {
 public:
  /// Why a tick was found bad; kNone if it was good.
  enum class Trip { kNone, kNonFinite, kSpeed, kEnergy };
  /// What must not be exceeded. All come from the material, none from the scene's taste.
  struct Limits {
    double speed_m_per_s;  ///< 5 times the fastest of waves and of fragments that fall to where they sleep
    double energy_j;       ///< all of the tissue moving as fast as waves, plus its fall
  };
  /// What a tick must not exceed, of energy without the work of its own tools.
  struct Bounds {
    double speed_m_per_s, energy_j;
  };
  static constexpr double kEnergyMargin = 2;  ///< energies are measured with velocities of half a substep ago

  Governor(const Limits& limits, double tick_s, double recovery_s);

  /// @param implicit  of an integrator that may be fast
  Bounds bounds(bool implicit) const;
  /// What judge() would say, without consequences.
  Trip inspect(const layout::TickStats& stats, bool implicit, double work_j = 0) const;

  /// Judges the tick that the measurement belongs to. @param implicit  it was made by an integrator that may be fast
  /// @param work_j  that tools did on the tissue in this tick
  /// @param long_substeps  it had substeps longer than proven ones (solver.measured_limit): a trip has shorter ones for
  /// recovery_s first, and no recovery
  Trip judge(const layout::TickStats& stats, bool implicit, double work_j = 0, bool long_substeps = false);
  /// A state was written from outside: what is measured of it, whatever it is, is the new start.
  void restart(const layout::TickStats& stats);
  const Health& health() const { return health_; }
  /// Rollbacks in a row without a good tick between them: how far back the next one should go.
  int setbacks() const { return setbacks_; }

 private:
  void note(const layout::TickStats& stats);
  void recover();
  void shorten();

  Limits limits_;
  double tick_s_, recovery_s_;
  Health health_;
  double owned_j_ = 0;  ///< energy that the tissue may have: the least since the start, plus what tools put in since
  int64_t recovery_ticks_left_ = 0;
  int64_t short_ticks_left_ = 0;  ///< that are taken for strained
  double short_wanted_s_ = 0;     ///< grows with trips that come soon after one
  int64_t ticks_since_short_ = 0;
  double recovery_wanted_s_;  ///< grows with trips that come soon after a recovery
  int64_t ticks_since_recovery_ = 0;
  int setbacks_ = 0;
};

/// @param gravity_m_per_s2  size   @param sleep_distance_m  how far fragments fall
Governor::Limits governorLimits(const Model& model, double gravity_m_per_s2, double sleep_distance_m);

}  // namespace viscera
