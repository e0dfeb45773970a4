// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <sensor_msgs/JointState.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "devices/arm_motion.h"
#include "nodes/hands/stylus_mailbox.h"

namespace viscera::nodes {

/// A tool that is a CRTK arm: it takes servo_cp, servo_cv, move_cp, hold, jaw/servo_jp, jaw/move_jp and state_command,
/// and tells measured_cp, setpoint_cp, goal_cp, measured_cv, operating_state and its jaws (docs/devices.md). What it
/// feels is its ForceSink's. Where it is told to be is told faster than ticks come: clients wait for such messages.
class CrtkArm {
 public:
  /// @param mailbox  of its stylus; must outlive this
  explicit CrtkArm(StylusMailbox& mailbox);

  /// @param lookup  of the frames of commands
  void subscribe(ros::NodeHandle& node, FrameLookup lookup);
  /// A tick begins: the arm has gone on. On the thread that steps, as endTick().
  void beginTick();
  /// @param tool  where it is at the end of the tick   @param jaw_moment_nm  Frame::jaw_moments_nm
  void endTick(const StylusMotion& tool, double jaw_moment_nm, const ros::Time& stamp);
  bool hasClient() const;

 private:
  void onServo(const geometry_msgs::PoseStamped& message);
  void onMove(const geometry_msgs::PoseStamped& message);
  void onVelocity(const geometry_msgs::TwistStamped& message);
  void onHold();
  void onJaw(const sensor_msgs::JointState& message, bool moves);
  void onState(const crtk_msgs::StringStamped& message);
  std::optional<Pose> inBase(const geometry_msgs::PoseStamped& message, const std::string& topic);
  bool isOfBase(const std::string& frame) const;
  std::optional<Pose> placeOf(const std::string& frame, const std::string& topic);
  void refuse(const std::string& topic, Drop reason, const std::string& detail = "");
  void place();
  void tellSetpoints();
  void tellState();

  StylusMailbox& mailbox_;
  FrameLookup lookup_;
  std::string base_;  ///< topics begin with it
  mutable std::mutex mutex_;
  ArmMotion motion_;
  bool told_busy_ = false, warned_ = false;
  const std::string frame_;  ///< of the arm's base, as the profile has it; empty: the tissue frame
  SteadyTime ticked_{};
  Pose last_measured_;
  std::optional<sensor_msgs::JointState> measured_jaw_;  ///< of a tool with jaws; others have what they are told
  ros::Time last_told_;
  std::vector<ros::Subscriber> commands_;
  ros::SteadyTimer setpoints_;
  ros::Publisher measured_cp_, setpoint_cp_, goal_cp_, measured_cv_, operating_state_, measured_js_, setpoint_js_;
};

}  // namespace viscera::nodes
