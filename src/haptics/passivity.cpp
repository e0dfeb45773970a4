// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/passivity.h"

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

/// Below this speed the damper fades out: encoder noise and tremor have no direction to damp [m/s].
constexpr double kSlow_m_per_s = 0.01;
/// Margin of the stored energy, which is computed from the stiffness at the last tick: for a sphere, with stiffness
/// that grows with depth, it is a fifth too low.
constexpr double kStoredMargin = 1.25;
/// Number of forces per period: the evaluated force, and one that a limit allows between two evaluations.
constexpr double kForcesPerPeriod = 2;

/// Time constant after which energy that is owed is forgotten: a user who only holds does not pay for it.
constexpr double kForgottenTime_s = 5;

}  // namespace

SentForces::SentForces(double span_s, double period_s)
    : entries_(2 + static_cast<size_t>(std::ceil(kForcesPerPeriod * span_s / period_s))) {}

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
  return Vector3d(Vector3d::Zero());  // there was no force before the first
}

std::optional<Vector3d> SentForces::between(double from_s, double to_s) const {
  const std::optional<Vector3d> from = sumAt(from_s), to = sumAt(to_s);
  if (!from || !to) return std::nullopt;
  return Vector3d(*to - *from);
}

PassivityControl::PassivityControl(const PassivityLimits& limits)
    : limits_(limits), sent_(limits.round_trip_s + kLongestTransit_s, limits.period_s) {}

void PassivityControl::clear() {
  sent_.clear();
  budget_j_ = damping_ = 0;
}

std::optional<Vector3d> PassivityControl::moved(const Vector3d& offset_m, double from_s, double to_s) {
  const std::optional<Vector3d> sum = sent_.between(from_s - limits_.round_trip_s, to_s - limits_.round_trip_s);
  if (!sum) {
    budget_j_ = 0;
    return std::nullopt;
  }
  const Vector3d acted_n = *sum / (to_s - from_s);
  const double given_j = -acted_n.dot(offset_m);
  energy_j_ += given_j;
  least_j_ = std::min(least_j_, energy_j_);
  budget_j_ += given_j;
  if (budget_j_ < 0) budget_j_ *= std::exp(-(to_s - from_s) / kForgottenTime_s);
  return acted_n;
}

Vector3d PassivityControl::damped(const Vector3d& velocity, const Vector3d& wanted_n, double stored_j,
                                  double pose_time_s, double now_s, double strength, double sure) {
  const double speed = velocity.norm(), stored = kStoredMargin * stored_j;
  budget_j_ = std::min(budget_j_, stored + limits_.most_reserve_j);
  damping_ = 0;
  const double out_n = speed > 0 ? wanted_n.dot(velocity) / speed : 0;
  // The work of forces in transit on the device if it keeps its velocity.
  const Vector3d in_transit_n_s = sent_.between(pose_time_s - limits_.round_trip_s, now_s).value_or(Vector3d::Zero());
  const double left_j = std::max(budget_j_ - in_transit_n_s.dot(velocity), 0.0);
  if (out_n > 0 && left_j < stored)
    damping_ = (1 - left_j / stored) * out_n * speed / (speed * speed + kSlow_m_per_s * kSlow_m_per_s);
  damping_ = std::max(strength * damping_, std::min(damping_, sure));
  return wanted_n - damping_ * velocity;
}

}  // namespace viscera
