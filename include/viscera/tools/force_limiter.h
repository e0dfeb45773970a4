// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "viscera/math/types.h"

namespace viscera {

struct StylusConfig;

/// Reaction force and torque on a stylus, tissue frame, acting at the tip.
struct Reaction {
  Vector3d force_n = Vector3d::Zero();
  Vector3d torque_nm = Vector3d::Zero();
  bool saturated = false;
};

/// The share of a force or torque that a limit lets through, at most all of it. All limits on the wrench of a stylus
/// are this rule, each for its own purpose: a Session limits its answers in simulated time, so that results do not
/// depend on how fast it runs; what devices are told is limited again in wall-clock time, in which hands feel it; and
/// each device once more along its own axes, by what it is made for, whatever the scene allows.
inline double shareWithin(double size, double most) {
  return size > most ? most / size : 1;
}
/// The one share of both, so that the line of action stays.
inline double shareWithin(const Vector3d& force_n, const Vector3d& torque_nm, double most_n, double most_nm) {
  return std::min(shareWithin(force_n.norm(), most_n), shareWithin(torque_nm.norm(), most_nm));
}

/// What a device may be given: sizes, and how fast they may change. A size of 0 leaves that part out: a device that has
/// no torque feels the whole force.
struct ForceLimits {
  double force_n, force_rate_n_per_s;
  double torque_nm = std::numeric_limits<double>::infinity();
  double torque_rate_nm_per_s = std::numeric_limits<double>::infinity();

  /// Those of a stylus's keys.
  static ForceLimits of(const StylusConfig& stylus);
};

/// Saturates force and torque and limits their slew from one answer to the next (physics.md 5). Both shrink by one
/// factor, and go on by one share of the way, so that the line of action stays where tissue put it.
class ForceLimiter {
 public:
  explicit ForceLimiter(const ForceLimits& limits) : limits_(limits) {}
  /// @param span_s  since the answer before [s]
  /// @returns zero, at once, for a reaction that is not finite: the tissue is lost
  Reaction limit(const Reaction& raw, double span_s) { return limit(raw, span_s, limits_); }
  /// The same under other limits, this once.
  Reaction limit(const Reaction& raw, double span_s, const ForceLimits& limits);
  void reset() { last_ = Reaction{}; }
  /// The last answer, brought down to this at most, whatever the slew.
  const Reaction& shrink(double most_force_n, double most_torque_nm);
  /// Less was given than the last answer.
  void lessen(const Vector3d& force_n) { last_.force_n = force_n; }
  const Reaction& last() const { return last_; }
  void setLimits(const ForceLimits& limits) { limits_ = limits; }
  const ForceLimits& limits() const { return limits_; }

 private:
  ForceLimits limits_;
  Reaction last_;
};

}  // namespace viscera
