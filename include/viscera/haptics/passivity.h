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
  /// Mean over a time of the integral up to each of its moments, from the first force on [N s]. @param from_s  < to_s
  std::optional<Vector3d> meanSum(double from_s, double to_s) const;
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
  double most_owed_j = 7e-4;     ///< energy that may be given in advance, until the hand has made up for it
  double longest_trip_s = 1e-2;  ///< that mayTake() will name, unless a longer one is told
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
/// on what tissue has dissipated swings for long. What is owed, E < 0, stays owed from touch to touch.
///
/// What a force does before its effect is known cannot be taken back: bearable() holds forces to those that a hand as
/// fast as lately may carry away meanwhile at the cost of E and of most_owed_j.
///
/// How late forces act is told, and may be wrong: E is kept for several round trips, and of those that there may be the
/// least counts. All is in the hand's coordinates.
class PassivityControl {
 public:
  /// How far back forces are kept beyond a round trip [s]: poses that are farther apart tell nothing.
  static constexpr double kLongestWay_s = 0.1;

  explicit PassivityControl(const PassivityLimits& limits);

  /// The round trip may be any up to this one [s], whatever was told. At first it is the one that was told.
  void mayTake(double round_trip_s) { longest_s_ = round_trip_s; }
  /// The hand went from one place to another. @param from_s, to_s  when the two were told
  /// @returns the force that acted meanwhile, on average: by the round trip that was told, or, once energy is owed, by
  /// the one that owes most, of those that there may be. Nothing where it is not known: then nothing is booked either,
  /// and nothing is left of what the hand gave
  std::optional<Vector3d> moved(const Vector3d& way_m, double from_s, double to_s);
  /// The share of a force that may be given to a hand which is not heard of for a while.
  /// @param wanted_n    force on the hand   @param stored_j  U: energy that the tissue could give back
  /// @param fastest_m_per_s  of the hand, lately   @param unheard_s  between two poses, beyond a round trip
  double bearable(const Vector3d& wanted_n, double stored_j, double fastest_m_per_s, double unheard_s);
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
  /// The hand is another one, or was away: nothing is left of what it gave. What is owed stays.
  void forget();

  double energy_j() const { return trips_[0].energy_j; }  ///< given by the hand since the start; < 0: active
  double least_j() const { return trips_[0].least_j; }    ///< of energy_j
  /// As least_j(), by the worst of the round trips that there may be.
  double surely_j() const;
  double damping_n_s_per_m() const { return damping_; }  ///< alpha of the last force
  const SentForces& sentForces() const { return sent_; }

 private:
  /// What is booked if forces act so late.
  struct Trip {
    double round_trip_s = 0;
    double energy_j = 0, least_j = 0;
    double budget_j = 0;  ///< what is left of it; < 0: owed
    Vector3d acted_n = Vector3d::Zero();
  };
  void book(Trip& trip, const Vector3d& way_m, double span_s) const;
  bool maybe(const Trip& trip) const;
  const Trip& worst() const;

  PassivityLimits limits_;
  SentForces sent_;
  std::vector<Trip> trips_;  ///< the first is the one that was told
  double longest_s_, damping_ = 0;
  bool resting_ = false;  ///< the hand is away from tissue, and slow
};

}  // namespace viscera
