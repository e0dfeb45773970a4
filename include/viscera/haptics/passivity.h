// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// History of the forces on the device, by the times at which they were sent.
class VISCERA_PUBLIC SentForces {
 public:
  /// @param span_s  least length of the history [s]   @param period_s  approximate time between two forces [s]
  SentForces(double span_s, double period_s);

  /// Records the force that acts from now on. @param now_s  never goes back
  void add(const Vector3d& force_n, double now_s);
  /// Returns the integral of the force over time [N s]. `to_s` may be the present. Returns nothing if the history does
  /// not reach back to `from_s`.
  std::optional<Vector3d> between(double from_s, double to_s) const;
  void clear() { count_ = 0; }

 private:
  struct Entry {
    double time_s = 0;
    Vector3d force_n = Vector3d::Zero(), sum_n_s = Vector3d::Zero();  ///< force, and integral of the forces before it
  };
  const Entry& back(size_t i) const { return entries_[(head_ + entries_.size() - i) % entries_.size()]; }
  std::optional<Vector3d> sumAt(double time_s) const;

  std::vector<Entry> entries_;  ///< ring buffer
  size_t head_ = 0, count_ = 0;
};

struct PassivityLimits {
  double period_s = 1e-3;        ///< period of the loop [s]
  double round_trip_s = 0;       ///< time from the measurement of a pose at the device to its force acting there [s]
  double most_reserve_j = 1e-3;  ///< energy that is kept for later, in addition to the energy stored in tissue [J]
};

/// Passivity observer and controller of one port, time domain, impedance causality (B. Hannaford and J.-H. Ryu, IEEE
/// Trans. Robotics and Automation 18, 2002): the user moves the device, the controller applies forces.
///
///     observer    E(n) = E(n-1) - f . dx       energy that the user has given to the tissue
///     controller  f -> f - alpha v             damper that acts while the tissue would give back more than it received
///
/// dx is the displacement of the device between two poses, f the mean force that acted meanwhile: the force sent one
/// round trip earlier. Hannaford and Ryu take alpha = -E / (v.v T) once E is below 0. This controller acts earlier. If
/// the energy U stored in the tissue exceeds the remaining E, only the share E / U of the force may do work on the
/// user. Both reach zero together, and the force never changes its sign.
/// The remaining E is limited to U plus a reserve: a loop that uses the energy which tissue has dissipated oscillates
/// for long. All quantities are in the coordinates of the device.
class VISCERA_PUBLIC PassivityControl {
 public:
  /// Length of the force history in addition to a round trip [s]: poses further apart are not used.
  static constexpr double kLongestTransit_s = 0.1;

  explicit PassivityControl(const PassivityLimits& limits);

  /// Records a displacement of the device. @param from_s, to_s  times of the two poses
  /// @returns the mean force that acted meanwhile. If it is not known, returns nothing, adds no energy, and sets the
  /// remaining energy to zero.
  std::optional<Vector3d> moved(const Vector3d& offset_m, double from_s, double to_s);
  /// Damps a force so that the remaining energy stays positive.
  /// @param velocity_m_per_s  of the device, smoothed
  /// @param wanted_n    force on the device, within every limit
  /// @param stored_j    U: energy that the tissue can give back
  /// @param pose_time_s      time of the last pose   @param now_s  never goes back
  /// @param strength    of the controller, 0..1   @param sure_n_s_per_m  damping that is applied at any strength
  /// @returns the force to send
  Vector3d damped(const Vector3d& velocity_m_per_s, const Vector3d& wanted_n, double stored_j, double pose_time_s,
                  double now_s, double strength = 1, double sure_n_s_per_m = 0);
  /// Records the force that acts from now on.
  void sent(const Vector3d& force_n, double now_s) { sent_.add(force_n, now_s); }
  /// Sets the remaining energy to zero, because tracking was lost or the user may be another one.
  void clear();

  double energy_j() const { return energy_j_; }                ///< energy given by the user [J]; < 0: active
  double least_j() const { return least_j_; }                  ///< smallest energy_j so far [J]
  double owed_j() const { return std::max(-budget_j_, 0.0); }  ///< energy that the user has been given in advance [J]
  double damping_n_s_per_m() const { return damping_; }        ///< alpha of the last force [N s/m]

 private:
  PassivityLimits limits_;
  SentForces sent_;
  double energy_j_ = 0, least_j_ = 0, budget_j_ = 0, damping_ = 0;
};

}  // namespace viscera
