// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

struct StylusConfig;

/// Reaction force and torque on a stylus, tissue frame, acting at the tip.
struct Reaction {
  Vector3d force_n = Vector3d::Zero();
  Vector3d torque_nm = Vector3d::Zero();
  bool saturated = false;
};

/// Returns the share of a force or torque that a limit lets through, at most 1. All limits on the wrench of a stylus
/// follow this rule. A Session limits its reactions in simulated time, so that results do not depend on its speed.
/// Commands to devices are limited again in wall-clock time, in which the user feels them. Each device is limited once
/// more along its own axes by its rating, whatever the scene allows.
inline double shareWithin(double size, double most) {
  return size > most ? most / size : 1;
}
/// Returns the one share for both, so that the line of action is kept.
inline double shareWithin(const Vector3d& force_n, const Vector3d& torque_nm, double most_n, double most_nm) {
  return std::min(shareWithin(force_n.norm(), most_n), shareWithin(torque_nm.norm(), most_nm));
}

/// Limits on the wrench of a device: magnitudes and their rates of change. A magnitude of 0 leaves that component out:
/// a device without torque feels the whole force.
struct ForceLimits {
  double force_n, force_rate_n_per_s;
  double torque_nm = std::numeric_limits<double>::infinity();
  double torque_rate_nm_per_s = std::numeric_limits<double>::infinity();

  /// Returns the limits of a stylus's keys.
  static ForceLimits of(const StylusConfig& stylus);
};

/// Limiter that saturates force and torque and limits their rate from one reaction to the next (physics.md 5). Both are
/// scaled by one factor, and both changes by one factor, so that the line of action stays where the tissue put it.
class VISCERA_PUBLIC ForceLimiter {
 public:
  explicit ForceLimiter(const ForceLimits& limits) : limits_(limits) {}
  /// Limits a reaction.
  /// @param span_s  time since the previous reaction [s]
  /// @returns zero, without a rate limit, for a reaction that is not finite: the tissue is lost
  Reaction limit(const Reaction& raw, double span_s) { return limit(raw, span_s, limits_); }
  /// Limits this reaction by other limits.
  Reaction limit(const Reaction& raw, double span_s, const ForceLimits& limits);
  void reset() { last_ = Reaction{}; }
  /// Scales the last reaction down to these magnitudes, without a rate limit, and returns it.
  const Reaction& shrink(double most_force_n, double most_torque_nm);
  /// Records that a smaller force than the last reaction was applied.
  void lessen(const Vector3d& force_n) { last_.force_n = force_n; }
  const Reaction& last() const { return last_; }
  void setLimits(const ForceLimits& limits) { limits_ = limits; }
  const ForceLimits& limits() const { return limits_; }

 private:
  ForceLimits limits_;
  Reaction last_;
};

}  // namespace viscera
