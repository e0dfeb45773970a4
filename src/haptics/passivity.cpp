// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/passivity.h"

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

/// Below this speed the damper fades away: noise of an encoder, and tremor, have no direction to be braked [m/s].
constexpr double kSlow_m_per_s = 0.01;
/// What tissue stores is known by its stiffness at the last tick alone: with that of a sphere, which grows with depth,
/// too low by a fifth.
constexpr double kStoredMargin = 1.25;

}  // namespace

PassivityControl::PassivityControl(const PassivityLimits& limits)
    : limits_(limits),
      sent_n_(1 + static_cast<size_t>(std::lround(limits.round_trip_s / limits.period_s)), Vector3d::Zero()) {}

void PassivityControl::reset() {
  std::fill(sent_n_.begin(), sent_n_.end(), Vector3d::Zero());
  energy_j_ = least_j_ = budget_j_ = damping_ = 0;
}

/// What the forces that are on their way will give if the tip goes on as it does: work on the hand [J].
double PassivityControl::underWay(const Vector3d& way_m) const {
  double work_j = 0;
  for (size_t i = 0; i < sent_n_.size(); ++i)
    if (i != head_) work_j += sent_n_[i].dot(way_m);
  return work_j;
}

Vector3d PassivityControl::step(const Vector3d& moved_m, const Vector3d& velocity, const Vector3d& wanted_n,
                                double stored_j, double strength) {
  const size_t oldest = (head_ + 1) % sent_n_.size();
  const double given_j = -sent_n_[oldest].dot(moved_m);
  energy_j_ += given_j;
  least_j_ = std::min(least_j_, energy_j_);
  budget_j_ = std::min(budget_j_ + given_j, kStoredMargin * stored_j + limits_.most_reserve_j);
  head_ = oldest;

  const double speed = velocity.norm(), stored = kStoredMargin * stored_j;
  damping_ = 0;
  const double out_n = speed > 0 ? wanted_n.dot(velocity) / speed : 0;
  const double left_j = std::max(budget_j_ - underWay(limits_.period_s * velocity), 0.0);
  if (out_n > 0 && left_j < stored)
    damping_ = strength * (1 - left_j / stored) * out_n * speed / (speed * speed + kSlow_m_per_s * kSlow_m_per_s);
  sent_n_[head_] = wanted_n - damping_ * velocity;
  return sent_n_[head_];
}

}  // namespace viscera
