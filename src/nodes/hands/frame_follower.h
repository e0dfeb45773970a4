// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "nodes/hands/stylus_mailbox.h"

namespace viscera::nodes {

/// Tells of a tracker that only broadcasts a frame, as soon as tf has heard of it again.
class FrameFollower {
 public:
  /// What was heard: on the thread that listens to tf.
  using Heard = std::function<void(const geometry_msgs::TransformStamped&)>;
  /// @param frames  must outlive this
  FrameFollower(tf2_ros::Buffer& frames, const std::string& base, const std::string& frame, Heard heard);
  /// Waits for a call that is under way.
  ~FrameFollower();
  FrameFollower(const FrameFollower&) = delete;
  FrameFollower& operator=(const FrameFollower&) = delete;

  bool found() const;  ///< tf has known the frame

 private:
  struct Listener;  ///< what tf holds on to, for as long as it calls
  tf2_ros::Buffer& frames_;
  std::shared_ptr<Listener> listener_;
  boost::signals2::connection connection_;
};

}  // namespace viscera::nodes
