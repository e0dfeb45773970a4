// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// What a hand was told lately, by the time at which it was sent.
class SentForces {
 public:
  /// @param span_s  how far back it is known, at least [s]   @param period_s  between two forces, about [s]
  SentForces(double span_s, double period_s);

  /// From now on the hand is told this. @param now_s  never goes back
  void add(const Vector3d& force_n, double now_s);
  /// Integral over time [N s] from one moment to another, which may be the present one; nothing where it is not known
  /// so far back.
  std::optional<Vector3d> between(double from_s, double to_s) const;
  void clear() { count_ = 0; }

 private:
  struct Entry {
    double time_s = 0;
    Vector3d force_n = Vector3d::Zero(), sum_n_s = Vector3d::Zero();  ///< the sum is of what came before it
  };
  const Entry& back(size_t i) const { return entries_[(head_ + entries_.size() - i) % entries_.size()]; }
  std::optional<Vector3d> sumAt(double time_s) const;

  std::vector<Entry> entries_;  ///< a ring
  size_t head_ = 0, count_ = 0;
};

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
/// dx is the hand's own way from one pose to the next, f the mean of what acted on it meanwhile: what was sent a round
/// trip ago. Theirs takes alpha = -E / (v.v T) once E is below 0. Ours acts before: where the tissue's store U is
/// larger than what is left of E, only the share E / U of the force may do work on the hand, so that both come to
/// nothing together, and no force is ever turned round. What is left of E is at most U and a reserve: a loop that feeds
/// on what tissue has dissipated swings for long. All is in the hand's coordinates.
class PassivityControl {
 public:
  /// How far back forces are kept beyond a round trip [s]: poses that are farther apart tell nothing.
  static constexpr double kLongestWay_s = 0.1;

  explicit PassivityControl(const PassivityLimits& limits);

  /// The hand went from one place to another. @param from_s, to_s  when the two were told
  /// @returns the force that acted meanwhile, on average. Nothing where it is not known: then nothing is booked either,
  /// and nothing is left of what the hand gave
  std::optional<Vector3d> moved(const Vector3d& way_m, double from_s, double to_s);
  /// A force that keeps what is left of E.
  /// @param velocity_m_per_s  of the tip, smoothed
  /// @param wanted_n    force on the hand, within every limit
  /// @param stored_j    U: energy that the tissue could give back
  /// @param told_s      when the last pose was told   @param now_s  never goes back
  /// @param strength    of the controller, 0..1   @param sure_n_s_per_m  so much damping it may give at any strength
  /// @returns the force that is to be sent
  Vector3d damped(const Vector3d& velocity_m_per_s, const Vector3d& wanted_n, double stored_j, double told_s,
                  double now_s, double strength = 1, double sure_n_s_per_m = 0);
  /// What the hand is told from now on.
  void sent(const Vector3d& force_n, double now_s) { sent_.add(force_n, now_s); }
  /// The hand is another one, or was away: nothing is left of what it gave.
  void forget();

  double energy_j() const { return energy_j_; }          ///< given by the hand since the start; < 0: active
  double least_j() const { return least_j_; }            ///< of energy_j
  double damping_n_s_per_m() const { return damping_; }  ///< alpha of the last force

 private:
  PassivityLimits limits_;
  SentForces sent_;
  double energy_j_ = 0, least_j_ = 0, budget_j_ = 0, damping_ = 0;
};

}  // namespace viscera
