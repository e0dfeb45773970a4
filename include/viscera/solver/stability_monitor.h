// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/api.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// |L - l0| / l0 above which a tick is strained. The shorter substep that is proven for any state then follows, unless
/// the limit was measured and nothing else is wrong. Chosen by `viscera bench stability` (docs/verification.md).
constexpr double kStrainedStretch = 1.0;

/// Stability of a session: observations and actions of the stability monitor since the last reset. On the GPU the last
/// tick is not yet included.
struct Health {
  uint64_t trips = 0;       ///< number of ticks that were rolled back
  bool recovering = false;  ///< the tissue moves towards rest (physics.md 3); forces are zero
  bool strained = false;    ///< the state needs a shorter substep
  bool only_long = false;   ///< only long springs cause that, and no tool is at the tissue
  double kinetic_j = 0;     ///< kinetic energy of the last tick [J]; elastic_j likewise
  double elastic_j = 0;
};

/// Judge of the stability of ticks (physics.md 3). Logic on the host only; RollbackGuard carries out the decisions.
class VISCERA_PUBLIC StabilityMonitor {
 public:
  /// Reason why a tick was found bad; kNone if it was good.
  enum class Trip { kNone, kNonFinite, kSpeed, kEnergy };
  /// Largest admissible values. All follow from the material, none from other keys of the scene.
  struct Limits {
    double speed_m_per_s;  ///< 5 times the larger of the wave speed and the speed of fragments that fall to where they
                           ///< sleep [m/s]
    double energy_j;       ///< energy of all tissue moving at wave speed, plus that of its fall [J]
  };
  /// Largest values admitted in a tick; the energy is without the work of its own tools.
  struct Bounds {
    double speed_m_per_s, energy_j;
  };
  static constexpr double kEnergyMargin = 2;  ///< energies use velocities of half a substep earlier

  StabilityMonitor(const Limits& limits, double tick_s, double recovery_s);

  /// Returns the bounds of the next tick. @param implicit  the integrator is implicit and may be fast
  Bounds bounds(bool implicit) const;
  /// Returns what judge() would return, without side effects.
  Trip inspect(const layout::TickStats& stats, bool implicit, double work_j = 0) const;

  /// Judges the tick of a measurement. @param implicit  the tick was made by an implicit integrator, which may be fast
  /// @param work_j  work of tools on the tissue in this tick
  /// @param long_substeps  the tick had substeps longer than the proven ones (solver.measured_limit): a trip first
  /// shortens them for recovery_s, without a recovery
  Trip judge(const layout::TickStats& stats, bool implicit, double work_j = 0, bool long_substeps = false);
  /// Takes the measurements of a state that was written from outside as the new start, whatever they are.
  void restart(const layout::TickStats& stats);
  const Health& health() const { return health_; }
  /// Returns the number of rollbacks in a row without a good tick between them: how far back the next one should go.
  int setbacks() const { return setbacks_; }

 private:
  void record(const layout::TickStats& stats);
  void recover();
  void shorten();

  Limits limits_;
  double tick_s_, recovery_s_;
  Health health_;
  double owned_j_ = 0;  ///< energy that the tissue may have [J]: the least so far, plus the work of tools since
  int64_t recovery_ticks_left_ = 0;
  int64_t short_ticks_left_ = 0;  ///< remaining ticks that count as strained
  double short_wanted_s_ = 0;     ///< duration of shorter substeps [s]; grows with trips that follow soon after one
  int64_t ticks_since_short_ = 0;
  double recovery_wanted_s_;  ///< duration of a recovery [s]; grows with trips that follow soon after one
  int64_t ticks_since_recovery_ = 0;
  int setbacks_ = 0;
};

/// Returns the limits of a model. @param gravity_m_per_s2  magnitude   @param sleep_distance_m  distance that fragments
/// fall
StabilityMonitor::Limits stabilityLimits(const Model& model, double gravity_m_per_s2, double sleep_distance_m);

}  // namespace viscera
