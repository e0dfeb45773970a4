// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

struct PassivityLimits {
  double period_s = 1e-3;        ///< of the loop
  double round_trip_s = 0;       ///< from a pose, measured at the device, to the force that answers it, acting there
  double most_reserve_j = 1e-3;  ///< energy beyond what the tissue stores that is kept for later
};

/// Passivity observer and controller of one port, time domain, impedance causality (B. Hannaford and J.-H. Ryu, IEEE
/// Trans. Robotics and Automation 18, 2002): the hand moves, we push.
///
///     observer    E(n) = E(n-1) - f . dx       energy that the hand has given the tissue
///     controller  f -> f - alpha v             a damper that acts while the tissue would give more than it has got
///
/// dx is the device's own way, f what acted at the device meanwhile: the answer of a round trip ago. Theirs takes
/// alpha = -E / (v.v T) once E is below 0. Ours acts before: where the tissue's store U is larger than what is left of
/// E, only the share E / U of the force may do work on the hand, so that both come to nothing together, and no force is
/// ever turned round. What is left of E is at most U and a reserve: a loop that feeds on what tissue has dissipated
/// would swing for long.
class PassivityControl {
 public:
  explicit PassivityControl(const PassivityLimits& limits);

  /// A period.
  /// @param moved_m     of the tip since the last call
  /// @param velocity_m_per_s  of the tip, smoothed
  /// @param wanted_n    force on the hand
  /// @param stored_j    U: energy that the tissue could give back
  /// @param strength    of the controller, 0..1
  /// @returns the force that is sent
  Vector3d step(const Vector3d& moved_m, const Vector3d& velocity_m_per_s, const Vector3d& wanted_n, double stored_j,
                double strength = 1);
  /// The force that step() returned last was not sent as it is: limits held it back.
  void sent(const Vector3d& force_n) { sent_n_[head_] = force_n; }
  /// What acts at the device between the pose that is measured now and the next one.
  const Vector3d& acting_n() const { return sent_n_[(head_ + 1) % sent_n_.size()]; }
  /// The hand is another one, or was away.
  void reset();

  double energy_j() const { return energy_j_; }          ///< given by the hand since the start or reset; < 0: active
  double least_j() const { return least_j_; }            ///< of energy_j
  double damping_n_s_per_m() const { return damping_; }  ///< alpha of the last period

 private:
  double underWay(const Vector3d& way_m) const;

  PassivityLimits limits_;
  std::vector<Vector3d> sent_n_;  ///< of a round trip, a ring
  size_t head_ = 0;
  double energy_j_ = 0, least_j_ = 0, budget_j_ = 0, damping_ = 0;
};

}  // namespace viscera
