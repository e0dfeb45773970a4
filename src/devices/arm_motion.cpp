// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/arm_motion.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kPeakOverMean = 15.0 / 8;  // ratio of the speeds along the path
constexpr double kRadPerDeg = 3.14159265358979323846 / 180;

double shareOfPath(double s) {
  return s * s * s * (10 + s * (-15 + 6 * s));
}

}  // namespace

const char* text(ArmMotion::State state) {
  switch (state) {
    case ArmMotion::State::kDisabled:
      return "DISABLED";
    case ArmMotion::State::kEnabled:
      return "ENABLED";
    case ArmMotion::State::kPaused:
      break;
  }
  return "PAUSED";
}

ArmMotion::ArmMotion(const ArmConfig& config)
    : config_(config),
      setpoint_{config.start_m, rotationFromDegrees(config.start_rotation_deg)},
      jaw_rad_(config.jaw_start_rad) {}

std::optional<std::string> ArmMotion::command(const std::string& text) {
  if (text == "enable" || text == "resume") {
    if (text == "resume" && state_ == State::kDisabled) return "'resume' needs an enabled arm";
    state_ = State::kEnabled;
  } else if (text == "disable") {
    state_ = State::kDisabled;
  } else if (text == "pause") {
    if (state_ == State::kDisabled) return "'pause' needs an enabled arm";
    state_ = State::kPaused;
  } else if (text == "home") {
    homed_ = true;
  } else if (text == "unhome") {
    homed_ = false;
  } else {
    return "'" + text + "' is not one of enable, disable, pause, resume, home, unhome";
  }
  if (state_ != State::kEnabled) {
    stop();
    jaw_path_ = {};
  }
  return std::nullopt;
}

bool ArmMotion::servo(const Pose& setpoint) {
  if (state_ != State::kEnabled) return false;
  stop();
  setpoint_ = setpoint;
  return true;
}

void ArmMotion::stop() {
  path_ = {};
  along_ = nullptr;
  velocity_left_s_ = 0;
}

void ArmMotion::Path::begin(double least_s) {
  // a goal that is already reached takes a moment too: a client that waits for the end must see a beginning
  *this = {std::max(kPeakOverMean * least_s, 1e-3), 0};
}

double ArmMotion::Path::advance(double span_s) {
  done_s += span_s;
  if (done_s < duration_s) return shareOfPath(done_s / duration_s);
  *this = {};
  return 1;
}

bool ArmMotion::move(const Pose& goal) {
  if (state_ != State::kEnabled) return false;
  stop();
  start_ = setpoint_;
  goal_ = goal;
  const double offset_m = (goal.position_m - start_.position_m).norm();
  const double turn_rad = start_.orientation.angularDistance(goal.orientation);
  path_.begin(std::max(offset_m / config_.speed_m_per_s, turn_rad / (kRadPerDeg * config_.turn_deg_per_s)));
  return true;
}

bool ArmMotion::moveAlong(const std::function<Pose(double share)>& path, double turn_rad, double slide_m) {
  if (state_ != State::kEnabled) return false;
  stop();
  along_ = path;
  goal_ = path(1);
  path_.begin(std::max(slide_m / config_.speed_m_per_s, turn_rad / (kRadPerDeg * config_.turn_deg_per_s)));
  return true;
}

bool ArmMotion::servoVelocity(const Vector3d& linear_m_per_s, const Vector3d& angular_rad_per_s) {
  if (state_ != State::kEnabled) return false;
  stop();
  linear_m_per_s_ = linear_m_per_s;
  angular_rad_per_s_ = angular_rad_per_s;
  velocity_left_s_ = kVelocityHolds_s;
  return true;
}

bool ArmMotion::servoJaw(double angle_rad) {
  if (state_ != State::kEnabled) return false;
  jaw_path_ = {};
  jaw_rad_ = angle_rad;
  return true;
}

bool ArmMotion::moveJaw(double goal_rad) {
  if (state_ != State::kEnabled) return false;
  jaw_start_rad_ = jaw_rad_;
  jaw_goal_rad_ = goal_rad;
  jaw_path_.begin(std::abs(goal_rad - jaw_rad_) / (kRadPerDeg * config_.turn_deg_per_s));
  return true;
}

bool ArmMotion::hold() {
  if (state_ != State::kEnabled) return false;
  stop();
  jaw_path_ = {};
  return true;
}

void ArmMotion::advance(double span_s) {
  if (path_.duration_s > 0) {
    const double share = path_.advance(span_s);
    setpoint_ = share == 1 ? goal_ : along_ ? along_(share) : interpolate(start_, goal_, share);
  }
  if (velocity_left_s_ > 0) {
    const double for_s = std::min(span_s, velocity_left_s_);
    velocity_left_s_ -= for_s;
    setpoint_.position_m += for_s * linear_m_per_s_;
    const double angle = for_s * angular_rad_per_s_.norm();
    if (angle > 0) {
      const Eigen::AngleAxisd turn(angle, angular_rad_per_s_.normalized());
      setpoint_.orientation = (turn * setpoint_.orientation).normalized();
    }
  }
  if (jaw_path_.duration_s > 0) {
    const double share = jaw_path_.advance(span_s);
    jaw_rad_ = share == 1 ? jaw_goal_rad_ : jaw_start_rad_ + share * (jaw_goal_rad_ - jaw_start_rad_);
  }
}

}  // namespace viscera
