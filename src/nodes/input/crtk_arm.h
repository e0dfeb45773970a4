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
#include "devices/da_vinci_arm.h"
#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {

/// A tool that acts as a CRTK arm (docs/devices.md). It subscribes to servo_cp, servo_cv, move_cp, hold, jaw/servo_jp,
/// jaw/move_jp and state_command. It publishes measured_cp, setpoint_cp, goal_cp, measured_cv, operating_state and the
/// state of its jaws. With the joints of a da Vinci it also takes servo_jp and move_jp, publishes measured_js and
/// setpoint_js, and goes only where they reach. Forces go through its ForceSink. Setpoints are published faster than
/// ticks come, since clients wait for such messages.
class CrtkArm {
 public:
  /// @param mailbox  mailbox of its stylus; must outlive this object
  explicit CrtkArm(StylusMailbox& mailbox);

  /// Subscribes to the commands. @param lookup  looks up the frames of commands
  void subscribe(ros::NodeHandle& node, FrameLookup lookup);
  /// Advances the arm at the beginning of a tick. Called on the stepping thread, as endTick() is.
  void beginTick();
  /// Publishes the state of the arm after a tick.
  /// @param tool  pose at the end of the tick   @param jaw_moment_nm  Frame::jaw_moments_nm
  void endTick(const StylusMotion& tool, double jaw_moment_nm, const ros::Time& stamp);
  bool hasClient() const;

 private:
  void onServo(const geometry_msgs::PoseStamped& message);
  void onMove(const geometry_msgs::PoseStamped& message);
  void onVelocity(const geometry_msgs::TwistStamped& message);
  void onJoints(const sensor_msgs::JointState& message, bool moves);
  void onHold();
  void onJaw(const sensor_msgs::JointState& message, bool moves);
  void onState(const crtk_msgs::StringStamped& message);
  std::optional<Pose> inBase(const geometry_msgs::PoseStamped& message, const std::string& topic);
  bool isOfBase(const std::string& frame) const;
  std::optional<Pose> poseOfFrame(const std::string& frame, const std::string& topic);
  void refuse(const std::string& topic, Drop reason, const std::string& detail = "");
  bool isReached(const Pose& pose, const std::string& topic);
  Pose reached(const Pose& pose) const;
  void stayWithinReach();
  sensor_msgs::JointState toJoints(const DaVinciArm::Joints& joints, const ros::Time& stamp) const;
  void place();
  void tellSetpoints();
  void tellState();

  StylusMailbox& mailbox_;
  FrameLookup lookup_;
  std::string base_;  ///< prefix of its topics
  mutable std::mutex mutex_;
  ArmMotion motion_;
  std::optional<DaVinciArm> arm_;                ///< joints, if it has some
  DaVinciArm::Joints joints_, measured_joints_;  ///< of the setpoint and of the tool
  bool sent_busy_ = false, warned_ = false;
  const std::string frame_;  ///< frame of the arm's base in the profile; empty: the tissue frame
  SteadyTime ticked_{};
  Pose last_measured_;
  std::optional<sensor_msgs::JointState> measured_jaw_;  ///< joint state of a tool with jaws; a tool without jaws
                                                         ///< reports the commanded one
  ros::Time last_sent_;
  std::vector<ros::Subscriber> commands_;
  ros::SteadyTimer setpoints_;
  ros::Publisher measured_cp_, setpoint_cp_, goal_cp_, measured_cv_, operating_state_, measured_js_, setpoint_js_;
  ros::Publisher measured_joints_js_, setpoint_joints_js_;
};

}  // namespace viscera::nodes
