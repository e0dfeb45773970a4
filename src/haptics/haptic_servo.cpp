// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/haptic_servo.h"

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

/// Time constant of the velocity for damping: long enough to smooth the encoder's steps.
constexpr double kVelocityTime_s = 3e-3;
/// Time constant for estimating the loop's own damping: some cycles of a light device's oscillation.
constexpr double kVelocityWindow_s = 0.1;
/// Time constant above which changes of force are not oscillations.
constexpr double kSwingTime_s = 0.03;
/// Damping that a user's hand certainly provides [N s/m].
constexpr double kAllowed_n_s_per_m = 1;
/// Slower motion is not judged, since it may be noise of an encoder [m/s].
constexpr double kJudged_m_per_s = 0.005;
/// Time constants for reducing stiffness while the loop feeds an oscillation, and for restoring it while the tip is
/// free.
constexpr double kSoftenTime_s = 0.02, kStiffenTime_s = 5;
constexpr double kLeastScale = 0.1;
/// Energy owed to the user from which forces of fast motion are reduced, and at which they are by most [J].
constexpr double kOwedFree_j = 5e-4, kOwedMost_j = 1e-3;
/// Speed that pokes exceed. Slower motion keeps its forces, since a light device that is held oscillates otherwise
/// [m/s].
constexpr double kPoke_m_per_s = 0.02;
/// Largest product of stiffness and delay, from a pose to its force, for fast motion: above it, the loop oscillates
/// before the oscillation is measured [N s/m].
constexpr double kBearable_n_s_per_m = 5;
/// Time constants after which a softened force reaches the full force.
constexpr double kCreepTime_s = 0.5, kLongestCreep_s = 4, kLongestHeld_s = 1;
/// Number of poses over which the time between poses is averaged.
constexpr double kPosesLookedAt = 8;
/// Limit of extrapolation beyond the newest pose, in times between poses: a pose that is missing carries no
/// information.
constexpr double kMostPosesAhead = 1.5;
/// Limit of the softened force relative to the tissue's: it ends where the tissue's force ends.
constexpr double kMostOver = 1.5;

/// Advances a first-order low-pass filter by one period.
template <typename T>
void approach(T& filtered, const T& value, double period_s, double time_s) {
  filtered += period_s / (period_s + time_s) * (value - filtered);
}

}  // namespace

HapticServo::HapticServo(const HapticServoConfig& config)
    : config_(config),
      model_(config.tissue),
      passivity_({config.period_s, config.round_trip_s}),
      lead_s_(0.5 * config.period_s + config.round_trip_s),
      between_poses_s_(config.period_s) {}

void HapticServo::put(const TickContact& contact, double now_s) {
  model_.put(contact, config_.tick_s, now_s);
}

void HapticServo::clear(double now_s) {
  model_.clear(config_.tick_s, now_s);
  leave();
}

void HapticServo::leave() {
  passivity_.clear();
  placed_ = false;
  for (Vector3d* each : {&moved_m_, &acting_n_, &velocity_, &acceleration_, &mean_n_, &slow_n_, &slower_n_})
    each->setZero();
  power_ = speed2_ = acceleration2_ = stored_j_ = 0;
}

/// Updates the motion of the device. The velocity is kept until the next position arrives, since a device may be slower
/// than the loop. A displacement across a gap is not motion.
void HapticServo::follow(const Vector3d& tip_m, double pose_time_s) {
  const Vector3d at_m = tip_m / config_.motion_scale;
  moved_m_.setZero();
  const double span_s = pose_time_s - pose_time_s_;
  if (placed_ && !(span_s > 0)) return;
  const Vector3d offset_m = at_m - at_m_;
  const std::optional<Vector3d> acted_n =
      placed_ ? passivity_.moved(offset_m, pose_time_s_, pose_time_s) : std::optional<Vector3d>();
  if (acted_n) {
    moved_m_ = offset_m;
    acting_n_ = *acted_n;
    const Vector3d change = (offset_m - span_s * velocity_) / (span_s + kVelocityTime_s);
    velocity_ += change;
    acceleration_ = change / std::max(span_s, config_.period_s);
    between_poses_s_ += (span_s - between_poses_s_) / kPosesLookedAt;
  } else {
    for (Vector3d* each : {&velocity_, &acceleration_, &acting_n_}) each->setZero();
  }
  placed_ = true;
  at_m_ = at_m;
  pose_time_s_ = pose_time_s;
}

/// Reduces the stiffness if the loop feeds an oscillation. The damping over the last cycles is
/// c = - sum(f . v) / sum(v . v), f without its slow part; energy stored for part of a cycle contributes
/// K / (omega^2 time). A light device behind a delay cannot be damped, so its stiffness is reduced for a while.
void HapticServo::judge() {
  const double dt = config_.period_s;
  approach(mean_n_, acting_n_, dt, kSwingTime_s);
  approach(power_, -(acting_n_ - mean_n_).dot(moved_m_) / dt, dt, kVelocityWindow_s);
  approach(speed2_, velocity_.squaredNorm(), dt, kVelocityWindow_s);
  approach(acceleration2_, acceleration_.squaredNorm(), dt, kVelocityWindow_s);
  const bool free = !(last_.force_n.squaredNorm() > 0);
  if (free) approach(stiffness_scale_, 1.0, dt, kStiffenTime_s);
  const double most = 1 - (1 - kLeastScale) * owedRatio();
  if (stiffness_scale_ > most) approach(stiffness_scale_, most, dt, kSoftenTime_s);
  if (!(speed2_ > kJudged_m_per_s * kJudged_m_per_s)) return;
  const double omega2 = acceleration2_ / speed2_;
  const double k = device_stiffness_n_per_m();
  const double allowed = kAllowed_n_s_per_m + k / (omega2 * kVelocityWindow_s);
  if (power_ < -allowed * speed2_)
    stiffness_scale_ = std::max(stiffness_scale_ - dt / kSoftenTime_s * stiffness_scale_, kLeastScale);
}

/// Returns the model's force; only a share of it follows fast motion. When the force has changed direction, the
/// component along its former direction is removed.
Vector3d HapticServo::softened(const Vector3d& wanted_n) {
  const double k = device_stiffness_n_per_m();
  if (stiffness_scale_ * k * late_s() > kBearable_n_s_per_m) stiffness_scale_ = kBearable_n_s_per_m / (k * late_s());
  // A lagging force is negative damping: (1 - share) K / (omega^2 time) after one stage, and 16 / (omega time)^2 of
  // that after two stages of half the time each. Heavy devices oscillate slowly.
  const double omega2 = speed2_ > 0 ? acceleration2_ / speed2_ : 0;
  const double bearable_s = omega2 > 0 ? (1 - stiffness_scale_) * k / (omega2 * kAllowed_n_s_per_m) : 0;
  // A probe is pushed out by the lagging force, which is smaller with one stage.
  const bool leaves = model_.kind() == TickContact::Kind::kPushes || model_.kind() == TickContact::Kind::kFree;
  const double time_s = std::clamp(bearable_s, kCreepTime_s, leaves ? kLongestCreep_s : kLongestHeld_s);
  approach(slow_n_, wanted_n, config_.period_s, leaves ? time_s : 0.5 * time_s);
  approach(slower_n_, slow_n_, config_.period_s, leaves ? 0 : 0.5 * time_s);
  const double size = wanted_n.norm();
  if (!(size > 0)) {
    // A tip that returns to a surface starts again. A suture is slack for moments of an oscillation, so its mean is
    // kept.
    if (model_.kind() != TickContact::Kind::kPulls) slow_n_ = slower_n_ = Vector3d::Zero();
    return wanted_n;
  }
  for (Vector3d* each : {&slow_n_, &slower_n_}) {
    const double along = each->dot(wanted_n) / (size * size);
    if (along < 0) *each -= along * wanted_n;
  }
  const Vector3d out = slower_n_ + stiffness_scale_ * (wanted_n - slower_n_);
  const double most = kMostOver * size, length = out.norm();
  return length > most ? Vector3d(most / length * out) : out;
}

/// Returns an upper bound of the full model's stiffness at the device [N/m].
double HapticServo::device_stiffness_n_per_m() const {
  return config_.motion_scale * config_.force_scale * last_.stiffness_n_per_m.norm();
}

/// Returns how far forces of fast motion are reduced until the user has given what is owed, 0..1.
double HapticServo::owedRatio() const {
  return std::clamp((passivity_.owed_j() - kOwedFree_j) / (kOwedMost_j - kOwedFree_j), 0.0, 1.0);
}

/// Returns how far motion is that of a poke and not that of a hold, 0..1.
double HapticServo::pokeRatio() const {
  const double v2 = velocity_.squaredNorm(), poke2 = kPoke_m_per_s * kPoke_m_per_s;
  return v2 * v2 / (v2 * v2 + poke2 * poke2);
}

double HapticServo::late_s() const {
  return lead_s_ + between_poses_s_;
}

Reaction HapticServo::step(const Vector3d& tip_m, double pose_time_s, double now_s) {
  follow(tip_m, pose_time_s);
  judge();
  const double age_s = std::min(now_s - pose_time_s_, kMostPosesAhead * between_poses_s_);
  last_ = model_.at(tip_m + (age_s + lead_s_) * config_.motion_scale * velocity_, now_s);
  const double force2 = last_.force_n.squaredNorm();
  const double k = force2 > 0 ? last_.force_n.dot(last_.stiffness_n_per_m * last_.force_n) / force2 : 0;
  stored_j_ = k > 0 ? config_.force_scale / config_.motion_scale * 0.5 * force2 / k : 0;
  const double owed = 1 - kOwedMost_j / std::max(passivity_.owed_j(), kOwedMost_j), gain = 1 - owed * pokeRatio();
  return {gain * softened(last_.force_n), last_.torque_nm, false};
}

Vector3d HapticServo::damped(const Vector3d& limited_n, double now_s) {
  if (!(config_.force_scale > 0)) return limited_n;
  // A late damper excites a light mass: for mass m and delay t it may be m / 2t at most. The oscillation shows
  // m > K / omega^2.
  const double least_kg =
      speed2_ > 0 && acceleration2_ > 0 ? stiffness_scale_ * device_stiffness_n_per_m() * speed2_ / acceleration2_ : 0;
  const double sure = 0.5 * least_kg / late_s();
  const double strength = std::max(stiffness_scale_, owedRatio() * pokeRatio());
  return passivity_.damped(velocity_, config_.force_scale * limited_n, stored_j_, pose_time_s_, now_s, strength, sure) /
         config_.force_scale;
}

}  // namespace viscera
