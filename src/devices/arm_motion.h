// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "devices/device_profile.h"

namespace viscera {

/// Setpoint and state of a CRTK arm. The caller supplies times; this class does not depend on ROS.
///
/// A `servo` command takes effect at once. A `move` command follows the straight line and the shortest rotation with
/// least jerk, 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan 1985); its peak speed is 15/8 of the mean. The jaws move
/// likewise.
class ArmMotion {
 public:
  enum class State { kDisabled, kEnabled, kPaused };

  explicit ArmMotion(const ArmConfig& config);

  /// Executes enable, disable, pause, resume, home or unhome, as in CRTK's state_command.
  /// @returns an error if the command is unknown or not possible in this state
  std::optional<std::string> command(const std::string& text);
  /// Sets the setpoint. @returns false if the arm cannot move because it is disabled or paused
  bool servo(const Pose& setpoint);
  bool move(const Pose& goal);
  /// Moves along a path of joints.
  /// @param path  pose at a share of the path, 0 to 1   @param turn_rad, slide_m  longest displacement of its joints
  bool moveAlong(const std::function<Pose(double share)>& path, double turn_rad, double slide_m);
  /// Sets velocities along and about the axes of the base, for kVelocityHolds_s unless the call is repeated.
  bool servoVelocity(const Vector3d& linear_m_per_s, const Vector3d& angular_rad_per_s);
  bool servoJaw(double angle_rad);
  bool moveJaw(double goal_rad);
  /// Stops the arm and its jaws where they are.
  bool hold();
  /// Advances the time by span_s.
  void advance(double span_s);

  State state() const { return state_; }
  bool homed() const { return homed_; }
  bool busy() const { return path_.duration_s > 0 || jaw_path_.duration_s > 0; }  ///< whether a move is in progress
  bool moves() const { return busy() || velocity_left_s_ > 0; }                   ///< whether the setpoint changes
  const Pose& setpoint() const { return setpoint_; }
  const Pose& goal() const { return path_.duration_s > 0 ? goal_ : setpoint_; }  ///< goal, or setpoint at rest
  double jaw_rad() const { return jaw_rad_; }
  static constexpr double kVelocityHolds_s = 0.1;  ///< duration of a velocity [s]: clients stream at 10 Hz or more

 private:
  /// Progress of a move.
  struct Path {
    double duration_s = 0, done_s = 0;  ///< 0: there is no move
    void begin(double least_s);
    /// Advances the progress. @returns the share of the path; 1 at its end, which also ends the move
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
  Path path_, jaw_path_;
  std::function<Pose(double share)> along_;  ///< path of a move; empty: the straight line
};

const char* text(ArmMotion::State state);  ///< name in CRTK: DISABLED, ENABLED, PAUSED

}  // namespace viscera
