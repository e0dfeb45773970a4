// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/buffer.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "nodes/input/crtk_arm.h"
#include "nodes/input/frame_follower.h"
#include "nodes/input/sender_watch.h"
#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {

/// Receives what the device of one stylus sends, as its profile says, and puts it into the stylus's mailbox.
class StylusInput {
 public:
  /// @param frames  must outlive this object
  /// @param max_transform_age_s  largest age of a moving frame's transform [s]
  StylusInput(const StylusConfig& config, const DeviceProfile& device, const std::string& tissue_frame,
              tf2_ros::Buffer& frames, double max_transform_age_s);
  StylusInput(const StylusInput&) = delete;
  StylusInput& operator=(const StylusInput&) = delete;

  /// Subscribes to the device. Called only when the simulation is ready, since a replay waits for a subscriber.
  void subscribe(ros::NodeHandle& node);
  /// Unsubscribes from the device; everything else stays.
  void unsubscribe();
  StylusMailbox& mailbox() { return mailbox_; }
  /// Begins a tick: advances an arm that moves by itself. Called on the stepping thread.
  void beginTick();
  /// Publishes the state of the jaws after a tick, and an arm's state for its clients.
  /// @param jaw_moment_nm  Frame::jaw_moments_nm
  void endTick(const StylusMotion& tool, double jaw_moment_nm, const ros::Time& stamp);
  /// Returns the nodes that send poses at the same time; empty if there are fewer than two.
  std::string rivals() const { return senders_.several(std::chrono::steady_clock::now()); }
  bool hasPublisher() const;

 private:
  void listenTo(ros::NodeHandle& node, const ButtonPort& port, ButtonRole role);
  void listenToGripper(ros::NodeHandle& node);
  void onTransform(const geometry_msgs::TransformStamped& newest);
  void onPose(const DevicePose& pose, const std::string& topic);
  void onButtons(const ButtonPort& port, ButtonRole role, const std::vector<int32_t>& values);
  void onGripper(const sensor_msgs::JointState& message);
  void warnOfIgnored(const std::string& topic, PressedButton button, uint64_t ignored_before);
  FramePose inTissue(const std::string& frame) const;
  void warn(const std::string& topic, std::optional<Drop> reason, const std::string& detail = "");

  tf2_ros::Buffer& frames_;
  const std::string tissue_frame_;
  const double max_transform_age_s_;
  StylusMailbox mailbox_;
  SenderWatch senders_;
  std::array<std::atomic<bool>, kDropReasons> warned_{};  ///< [reasons] whether it was warned of; set by threads of
                                                          ///< topics and of tf
  uint64_t reported_base_moves_ = 0;
  std::array<bool, 2> warned_ignored_{};  ///< [buttons] whether it was warned since the button last acted
  ros::Subscriber pose_;
  ros::Publisher jaw_;
  std::vector<ros::Subscriber> others_;  ///< subscribers of buttons and gripper
  std::unique_ptr<FrameFollower> follower_;
  std::unique_ptr<CrtkArm> arm_;
  std::atomic<bool> subscribed_{false};  ///< set after the subscribers, which the diagnostics read on another thread
};

}  // namespace viscera::nodes
