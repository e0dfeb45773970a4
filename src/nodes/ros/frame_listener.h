// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>

#include <string>

namespace viscera::nodes {

/// Passes messages of /tf and /tf_static to a buffer, as tf2_ros::TransformListener does, with two differences. Moving
/// frames that this node sends itself are left out if no frame depends on them. If the clock goes back, as when a bag
/// restarts, frames with stamps from before the jump are refused. One of them, received late, would make tf2 refuse all
/// later ones, each with a warning, until the clock reaches its stamp.
class FrameIntake {
 public:
  /// @param frames    must outlive this object
  /// @param left_out  name of the node to leave out, for moving frames; empty: none
  FrameIntake(tf2::BufferCore& frames, const std::string& left_out) : frames_(frames), left_out_(left_out) {}

  /// Adds the frames of a message.
  /// @param sender  name of the node   @param now  time by the clock of the stamps   @param fixed  from /tf_static
  void take(const tf2_msgs::TFMessage& message, const std::string& sender, const ros::Time& now, bool fixed);

 private:
  tf2::BufferCore& frames_;
  const std::string left_out_;
  ros::Time last_;  ///< time of the last message
};

/// Subscribes to both topics on a thread of its own.
class FrameListener {
 public:
  /// @param frames        must outlive this object
  /// @param own_left_out  whether to leave out the frames that this node sends on /tf
  FrameListener(tf2_ros::Buffer& frames, bool own_left_out);

 private:
  using Event = ros::MessageEvent<const tf2_msgs::TFMessage>;
  void hear(const Event& event, bool fixed);

  FrameIntake intake_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber moving_, fixed_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
