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
/// jerk, 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan 1985), whose greatest speed is 15/8 of the mean. So do its jaws.
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
  /// Goes on so, along and about the axes of the base, for kVelocityHolds_s unless it is told again.
  bool servoVelocity(const Vector3d& linear_m_per_s, const Vector3d& angular_rad_per_s);
  bool servoJaw(double angle_rad);
  bool moveJaw(double goal_rad);
  /// Stops where it is, its jaws too.
  bool hold();
  /// The time goes on by span_s.
  void advance(double span_s);

  State state() const { return state_; }
  bool homed() const { return homed_; }
  bool busy() const { return way_.duration_s > 0 || jaw_way_.duration_s > 0; }  ///< on its way to the goal of a move
  bool moves() const { return busy() || velocity_left_s_ > 0; }                 ///< advance() changes something
  const Pose& setpoint() const { return setpoint_; }
  const Pose& goal() const { return way_.duration_s > 0 ? goal_ : setpoint_; }  ///< of the move; else where it is
  double jaw_rad() const { return jaw_rad_; }
  static constexpr double kVelocityHolds_s = 0.1;  ///< a client that streams slower than 10 Hz has ended

 private:
  /// How far a move is.
  struct Way {
    double duration_s = 0, done_s = 0;  ///< 0: there is none
    void begin(double least_s);
    /// @returns the share of the way, 1 at its end, where there is none any more
    double advance(double span_s);
  };
  void stop();

  ArmConfig config_;
  State state_ = State::kEnabled;
  bool homed_ = true;
  Pose setpoint_, start_, goal_;
  Vector3d linear_m_per_s_ = Vector3d::Zero(), angular_rad_per_s_ = Vector3d::Zero();
  double velocity_left_s_ = 0;
  double jaw_rad_, jaw_start_rad_ = 0, jaw_goal_rad_ = 0;
  Way way_, jaw_way_;
};

const char* text(ArmMotion::State state);  ///< as CRTK names it: DISABLED, ENABLED, PAUSED

}  // namespace viscera
