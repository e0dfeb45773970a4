// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "devices/device_profile.h"

namespace viscera {

/// Where a CRTK arm is told to be, and in which state it is. Times are the caller's; nothing here knows ROS.
///
/// A `servo` is followed at once; a `move` takes its time: along the straight line and the shortest turn with the least
/// jerk, 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan 1985), whose greatest speed is 15/8 of the mean.
class ArmMotion {
 public:
  enum class State { kDisabled, kEnabled, kPaused };

  explicit ArmMotion(const ArmConfig& config);

  /// enable, disable, pause, resume, home, unhome: as CRTK's state_command has them.
  /// @returns what is wrong, if it is none of these or not possible in this state
  std::optional<std::string> command(const std::string& text);
  /// @returns false where the arm does not move: disabled or paused
  bool servo(const Pose& setpoint);
  bool move(const Pose& goal);
  bool servoJaw(double angle_rad);
  /// The time goes on by span_s.
  void advance(double span_s);

  State state() const { return state_; }
  bool homed() const { return homed_; }
  bool busy() const { return duration_s_ > 0; }  ///< on its way to the goal of a move
  const Pose& setpoint() const { return setpoint_; }
  double jaw_rad() const { return jaw_rad_; }

 private:
  void stop() { duration_s_ = 0; }

  ArmConfig config_;
  State state_ = State::kEnabled;
  bool homed_ = true;
  Pose setpoint_, start_, goal_;
  double duration_s_ = 0, done_s_ = 0;
  double jaw_rad_;
};

const char* text(ArmMotion::State state);  ///< as CRTK names it: DISABLED, ENABLED, PAUSED

}  // namespace viscera
