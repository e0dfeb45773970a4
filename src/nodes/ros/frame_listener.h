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

/// What of /tf and /tf_static a buffer is told. As tf2_ros::TransformListener has it, but for two things. Frames that
/// move and that this node sends itself are left out where nothing hangs on them. And when the clock goes back, as a
/// bag that begins again makes it, frames with stamps of before are refused: one of them, still on its way, would make
/// tf2 refuse all later ones, with a warning each, until the clock is where it was.
class FrameIntake {
 public:
  /// @param frames    must outlive this
  /// @param left_out  name of the node whose moving frames are left out; empty: of none
  FrameIntake(tf2::BufferCore& frames, const std::string& left_out) : frames_(frames), left_out_(left_out) {}

  /// @param sender  name of the node   @param now  of the clock that stamps go by   @param fixed  from /tf_static
  void take(const tf2_msgs::TFMessage& message, const std::string& sender, const ros::Time& now, bool fixed);

 private:
  tf2::BufferCore& frames_;
  const std::string left_out_;
  ros::Time last_;  ///< when a message was taken
};

/// Listens to both topics on a thread of its own.
class FrameListener {
 public:
  /// @param frames        must outlive this
  /// @param own_left_out  frames that this node sends on /tf are
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
