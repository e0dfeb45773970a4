// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/arm_motion.h"

#include <algorithm>

namespace viscera {

namespace {

constexpr double kPeakOverMean = 15.0 / 8;  // of the speed along the path
constexpr double kRadPerDeg = 3.14159265358979323846 / 180;

double shareOfWay(double s) {
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
    if (text == "resume" && state_ == State::kDisabled) return "'resume' needs an arm that is enabled";
    state_ = State::kEnabled;
  } else if (text == "disable") {
    state_ = State::kDisabled;
  } else if (text == "pause") {
    if (state_ == State::kDisabled) return "'pause' needs an arm that is enabled";
    state_ = State::kPaused;
  } else if (text == "home") {
    homed_ = true;
  } else if (text == "unhome") {
    homed_ = false;
  } else {
    return "'" + text + "' is none of enable, disable, pause, resume, home, unhome";
  }
  if (state_ != State::kEnabled) stop();
  return std::nullopt;
}

bool ArmMotion::servo(const Pose& setpoint) {
  if (state_ != State::kEnabled) return false;
  stop();
  setpoint_ = setpoint;
  return true;
}

bool ArmMotion::move(const Pose& goal) {
  if (state_ != State::kEnabled) return false;
  start_ = setpoint_;
  goal_ = goal;
  done_s_ = 0;
  const double way_m = (goal.position_m - start_.position_m).norm();
  const double turn_rad = start_.orientation.angularDistance(goal.orientation);
  const double longest_s = std::max(way_m / config_.speed_m_per_s, turn_rad / (kRadPerDeg * config_.turn_deg_per_s));
  // a goal that is there already takes a moment too: who waits for the end sees a beginning
  duration_s_ = std::max(kPeakOverMean * longest_s, 1e-3);
  return true;
}

bool ArmMotion::servoJaw(double angle_rad) {
  if (state_ != State::kEnabled) return false;
  jaw_rad_ = angle_rad;
  return true;
}

void ArmMotion::advance(double span_s) {
  if (!busy()) return;
  done_s_ += span_s;
  if (done_s_ >= duration_s_) {
    setpoint_ = goal_;
    stop();
  } else {
    setpoint_ = interpolate(start_, goal_, shareOfWay(done_s_ / duration_s_));
  }
}

}  // namespace viscera
