// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/passivity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

/// Below this speed the damper fades away: noise of an encoder, and tremor, have no direction to be braked [m/s].
constexpr double kSlow_m_per_s = 0.01;
/// What tissue stores is known by its stiffness at the last tick alone: with that of a sphere, which grows with depth,
/// too low by a fifth.
constexpr double kStoredMargin = 1.25;
/// Forces per period: the answer, and what a limit lets through between two answers.
constexpr double kForcesPerPeriod = 2;
/// The latter come at least so often, however slow the loop [s].
constexpr double kLongestPeriod_s = 2e-3;
/// Between round trips that are booked: energies in between are between theirs, nearly [s].
constexpr double kTripStep_s = 2e-3;
constexpr double kSame = 1e-6;  ///< of a step: rounding
/// A hand that is pushed leaves faster than it came.
constexpr double kFaster = 1.5;
/// Of what is left, a touch may spend a part: it ends in a turn that no loop can foresee, and the next one begins with
/// what is left then. At least so much is lent, by which a hand that owes all can make up for it [J].
constexpr double kPart = 0.65, kLeastLeft_j = 5e-5;
/// What is owed beyond this share of what may be is forgiven at a pace [W]; beyond all of it, within some of these [s].
constexpr double kOwedForGood = 0.9, kForgiven_w = 1e-4, kForgiven_s = 1;
/// A hand that is away from tissue and slower than this has ended its touches: what it owes is forgiven at a pace [W].
/// Else its next press, however slow, would be held back, and a device that is held so swings.
constexpr double kResting_m_per_s = 0.03, kForgivenAtRest_w = 0.02;
/// Of what may be owed, what a round trip owes at most that is none.
constexpr double kOwedElsewhere = 0.5;

}  // namespace

SentForces::SentForces(double span_s, double period_s)
    : entries_(2 + static_cast<size_t>(std::ceil(kForcesPerPeriod * span_s / std::min(period_s, kLongestPeriod_s)))) {}

void SentForces::add(const Vector3d& force_n, double now_s) {
  Entry next{now_s, force_n, Vector3d::Zero()};
  if (count_ > 0) next.sum_n_s = back(0).sum_n_s + (now_s - back(0).time_s) * back(0).force_n;
  head_ = (head_ + 1) % entries_.size();
  entries_[head_] = next;
  count_ = std::min(count_ + 1, entries_.size());
}

std::optional<Vector3d> SentForces::sumAt(double time_s) const {
  for (size_t i = 0; i < count_; ++i) {
    const Entry& entry = back(i);
    if (entry.time_s <= time_s) return entry.sum_n_s + (time_s - entry.time_s) * entry.force_n;
  }
  if (count_ == entries_.size()) return std::nullopt;
  return Vector3d(Vector3d::Zero());  // before the first one there was none
}

std::optional<Vector3d> SentForces::between(double from_s, double to_s) const {
  const std::optional<Vector3d> from = sumAt(from_s), to = sumAt(to_s);
  if (!from || !to) return std::nullopt;
  return Vector3d(*to - *from);
}

std::optional<Vector3d> SentForces::meanSum(double from_s, double to_s) const {
  Vector3d area = Vector3d::Zero();
  double until_s = to_s;
  for (size_t i = 0; i < count_; ++i) {
    const Entry& entry = back(i);
    if (entry.time_s >= until_s) continue;
    const double begin_s = std::max(entry.time_s, from_s), middle_s = 0.5 * (begin_s + until_s);
    area += (until_s - begin_s) * (entry.sum_n_s + (middle_s - entry.time_s) * entry.force_n);
    until_s = begin_s;
    if (until_s <= from_s) break;
  }
  if (until_s > from_s && count_ == entries_.size()) return std::nullopt;
  return Vector3d(area / (to_s - from_s));  // before the first one there was none
}

PassivityControl::PassivityControl(const PassivityLimits& limits)
    : limits_(limits),
      sent_(std::max(limits.round_trip_s, limits.longest_trip_s) + kLongestWay_s, limits.period_s),
      longest_s_(limits.round_trip_s) {
  trips_.push_back({limits.round_trip_s});
  const int steps = static_cast<int>(std::ceil(limits.longest_trip_s / kTripStep_s - kSame));
  for (int i = 0; i <= steps; ++i) trips_.push_back({std::min(i * kTripStep_s, limits.longest_trip_s)});
}

void PassivityControl::forget() {
  sent_.clear();
  for (Trip& trip : trips_) trip.budget_j = std::min(trip.budget_j, 0.0);
  damping_ = 0;
}

bool PassivityControl::maybe(const Trip& trip) const {
  return trip.round_trip_s <= std::max(longest_s_, limits_.round_trip_s) + kSame * kTripStep_s;
}

const PassivityControl::Trip& PassivityControl::worst() const {
  const Trip* out = &trips_[0];
  for (const Trip& trip : trips_)
    if (maybe(trip) && trip.budget_j < out->budget_j) out = &trip;
  return *out;
}

double PassivityControl::surely_j() const {
  double out = 0;
  for (const Trip& trip : trips_)
    if (maybe(trip)) out = std::min(out, trip.least_j);
  return out;
}

void PassivityControl::book(Trip& trip, const Vector3d& way_m, double span_s) const {
  const double given_j = -trip.acted_n.dot(way_m);
  trip.energy_j += given_j;
  trip.least_j = std::min(trip.least_j, trip.energy_j);
  trip.budget_j += given_j;
  const double beyond_j = -limits_.most_owed_j - trip.budget_j;
  if (trip.budget_j < -kOwedForGood * limits_.most_owed_j)
    trip.budget_j += span_s * (kForgiven_w + std::max(beyond_j, 0.0) / kForgiven_s);
  if (resting_) trip.budget_j = std::max(trip.budget_j, std::min(trip.budget_j + span_s * kForgivenAtRest_w, 0.0));
  // One that was excluded may come to count again; it is not to forbid all then.
  if (!maybe(trip)) trip.budget_j = std::max(trip.budget_j, -kOwedElsewhere * limits_.most_owed_j);
}

std::optional<Vector3d> PassivityControl::moved(const Vector3d& way_m, double from_s, double to_s) {
  for (Trip& trip : trips_) {
    const std::optional<Vector3d> sum = sent_.between(from_s - trip.round_trip_s, to_s - trip.round_trip_s);
    if (!sum) {
      for (Trip& each : trips_) each.budget_j = std::min(each.budget_j, 0.0);
      return std::nullopt;
    }
    trip.acted_n = *sum / (to_s - from_s);
  }
  for (Trip& trip : trips_) book(trip, way_m, to_s - from_s);
  const Trip& worst = this->worst();
  return worst.budget_j < 0 ? worst.acted_n : trips_[0].acted_n;
}

double PassivityControl::bearable(const Vector3d& wanted_n, double stored_j, double fastest_m_per_s, double unheard_s) {
  const double size_n = wanted_n.norm(), speed = std::max(kFaster * fastest_m_per_s - kSlow_m_per_s, 0.0);
  double out = 1;
  for (Trip& trip : trips_) {
    trip.budget_j = std::min(trip.budget_j, kStoredMargin * stored_j + limits_.most_reserve_j);
    if (!maybe(trip)) continue;
    const double carried_j = size_n * speed * (trip.round_trip_s + unheard_s);
    const double left_j = kPart * std::max(trip.budget_j + limits_.most_owed_j, kLeastLeft_j);
    if (carried_j > left_j) out = std::min(out, left_j / carried_j);
  }
  return out;
}

Vector3d PassivityControl::damped(const Vector3d& velocity, const Vector3d& wanted_n, double stored_j, double told_s,
                                  double now_s, double strength, double sure) {
  const double speed = velocity.norm(), stored = kStoredMargin * stored_j;
  double left_j = std::numeric_limits<double>::infinity();
  for (Trip& trip : trips_) {
    trip.budget_j = std::min(trip.budget_j, stored + limits_.most_reserve_j);
    if (!maybe(trip)) continue;
    // What forces that are on their way will do to the hand if it goes on as it does.
    const Vector3d under_way_n_s = sent_.between(told_s - trip.round_trip_s, now_s).value_or(Vector3d::Zero());
    left_j = std::min(left_j, std::max(trip.budget_j - under_way_n_s.dot(velocity), 0.0));
  }
  resting_ = !(stored > 0) && speed < kResting_m_per_s;
  damping_ = 0;
  const double out_n = speed > 0 ? wanted_n.dot(velocity) / speed : 0;
  if (out_n > 0 && left_j < stored)
    damping_ = (1 - left_j / stored) * out_n * speed / (speed * speed + kSlow_m_per_s * kSlow_m_per_s);
  damping_ = std::max(strength * damping_, std::min(damping_, sure));
  return wanted_n - damping_ * velocity;
}

}  // namespace viscera
