// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>

#include <array>
#include <atomic>
#include <string>

#include "nodes/sender_watch.h"
#include "nodes/stylus_mailbox.h"

namespace viscera::nodes {

/// Subscriptions of one stylus, `<stylus>/measured_cp`, `button1` and `button2`, into its mailbox.
class StylusInput {
 public:
  /// @param frames  must outlive this
  /// @param max_transform_age_s  of what tf knows of a frame that moves [s]
  StylusInput(const StylusConfig& config, const std::string& tissue_frame, const tf2_ros::Buffer& frames,
              double max_transform_age_s);
  StylusInput(const StylusInput&) = delete;
  StylusInput& operator=(const StylusInput&) = delete;

  /// Only now, when the simulation is ready, a device (or a replay that waits for a subscriber) is listened to.
  void subscribe(ros::NodeHandle& node);
  StylusMailbox& mailbox() { return mailbox_; }
  /// Nodes that send poses at the same time, if there are several; else empty.
  std::string rivals() const { return senders_.several(std::chrono::steady_clock::now()); }
  bool hasPublisher() const { return subscribed_ && pose_.getNumPublishers() > 0; }

 private:
  void onPose(const ros::MessageEvent<const geometry_msgs::PoseStamped>& event);
  void onButton(size_t button, const sensor_msgs::Joy& message);
  FramePlace inTissue(const std::string& frame) const;
  void warn(const std::string& topic, std::optional<Drop> reason, const std::string& detail = "");

  const tf2_ros::Buffer& frames_;
  const std::string tissue_frame_;
  const double max_transform_age_s_;
  StylusMailbox mailbox_;
  SenderWatch senders_;
  std::array<bool, kDropReasons> warned_{};
  ros::Subscriber pose_;
  std::array<ros::Subscriber, 2> buttons_;
  std::atomic<bool> subscribed_{false};  ///< set after the subscribers, which the diagnostics read on another thread
};

}  // namespace viscera::nodes
