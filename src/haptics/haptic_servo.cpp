// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/haptic_servo.h"

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

/// Of the velocity that damping acts on: long enough to smooth an encoder's steps.
constexpr double kVelocityTime_s = 3e-3;
/// Over this the loop's own damping is looked at: some cycles of what a light device swings with.
constexpr double kLookTime_s = 0.1;
/// Forces that change more slowly than this are no swing.
constexpr double kSwingTime_s = 0.03;
/// A hand's damping surely makes up for so much [N s/m].
constexpr double kAllowed_n_s_per_m = 1;
/// Motion that is slower is not judged: an encoder's noise [m/s].
constexpr double kJudged_m_per_s = 0.005;
/// How fast stiffness is taken away while the loop feeds a swing, and comes back while it is free.
constexpr double kSoftenTime_s = 0.02, kStiffenTime_s = 5;
constexpr double kLeastShare = 0.1;
/// What is softened comes up to the whole force within some of these.
constexpr double kCreepTime_s = 0.5;
/// Of what softened force there may be over the tissue's: it ends where the tissue's ends.
constexpr double kMostOver = 1.5;

/// Towards a value, as a filter of first order does in a period.
template <typename T>
void approach(T& filtered, const T& value, double period_s, double time_s) {
  filtered += period_s / (period_s + time_s) * (value - filtered);
}

}  // namespace

HapticServo::HapticServo(const HapticServoConfig& config)
    : config_(config),
      model_(config.tissue),
      passivity_({config.period_s, config.round_trip_s}),
      lead_s_(0.5 * config.period_s + config.round_trip_s) {}

void HapticServo::put(const TickContact& contact, double now_s) {
  model_.put(contact, config_.tick_s, now_s);
}

void HapticServo::forget(double now_s) {
  model_.forget(config_.tick_s, now_s);
  placed_ = false;
}

/// The velocity goes on as it was until the next place is told: a device may be slower than the loop.
void HapticServo::follow(const Vector3d& tip_m, double told_s) {
  moved_m_.setZero();
  acceleration_.setZero();
  if (!placed_) velocity_.setZero();
  const double span_s = told_s - told_s_;
  if (placed_ && span_s > 0) {
    moved_m_ = tip_m - tip_m_;
    const Vector3d change = (moved_m_ - span_s * velocity_) / (span_s + kVelocityTime_s);
    velocity_ += change;
    acceleration_ = change / span_s;
  }
  if (placed_ && !(span_s > 0)) return;
  placed_ = true;
  tip_m_ = tip_m;
  told_s_ = told_s;
}

/// Does the loop feed a swing? Its damping is c = - sum(f . v) / sum(v . v), f less its slow part, over the last
/// cycles; what is stored for a part of a cycle counts K / (omega^2 time). A light device behind a delay cannot be
/// damped: there what is stiff is made softer for a while.
void HapticServo::judge() {
  const double dt = config_.period_s;
  const Vector3d v = moved_m_ / dt;
  const Vector3d& acting = passivity_.acting_n();
  approach(mean_n_, acting, dt, kSwingTime_s);
  approach(power_, -(acting - mean_n_).dot(v), dt, kLookTime_s);
  approach(speed2_, velocity_.squaredNorm(), dt, kLookTime_s);
  approach(acceleration2_, acceleration_.squaredNorm(), dt, kLookTime_s);
  const bool free = !(last_.force_n.squaredNorm() > 0);
  if (free) approach(share_, 1.0, dt, kStiffenTime_s);
  if (!(speed2_ > kJudged_m_per_s * kJudged_m_per_s)) return;
  const double omega2 = acceleration2_ / speed2_;
  const double k = last_.stiffness_n_per_m.norm();
  const double allowed = kAllowed_n_s_per_m + k / (omega2 * kLookTime_s);
  if (power_ < -allowed * speed2_) share_ = std::max(share_ - dt / kSoftenTime_s * share_, kLeastShare);
}

/// The model's force, of which only a share follows fast motion.
Vector3d HapticServo::softened(const Vector3d& wanted_n) {
  const double size = wanted_n.norm();
  if (!(size > 0)) {
    slow_n_.setZero();
    return wanted_n;
  }
  approach(slow_n_, wanted_n, config_.period_s, kCreepTime_s);
  const Vector3d out = slow_n_ + share_ * (wanted_n - slow_n_);
  const double most = kMostOver * size, length = out.norm();
  return length > most ? Vector3d(most / length * out) : out;
}

Reaction HapticServo::step(const Vector3d& tip_m, double told_s, double now_s) {
  follow(tip_m, told_s);
  judge();
  last_ = model_.at(tip_m + lead_s_ * velocity_, now_s);
  const Vector3d wanted = softened(last_.force_n);
  const double force2 = last_.force_n.squaredNorm();
  const double k = force2 > 0 ? last_.force_n.dot(last_.stiffness_n_per_m * last_.force_n) / force2 : 0;
  const double stored_j = k > 0 ? 0.5 * force2 / k : 0;
  return {passivity_.step(moved_m_, velocity_, wanted, stored_j, share_), last_.torque_nm, false};
}

}  // namespace viscera
