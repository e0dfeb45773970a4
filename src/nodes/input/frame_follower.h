// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {

/// Reports the pose of a tracker that only broadcasts a frame, as soon as tf receives a new transform.
class FrameFollower {
 public:
  /// Callback for a new transform, on the thread that receives tf.
  using Heard = std::function<void(const geometry_msgs::TransformStamped&)>;
  /// @param frames  must outlive this object
  FrameFollower(tf2_ros::Buffer& frames, const std::string& base, const std::string& frame, Heard heard);
  /// Waits for a running callback.
  ~FrameFollower();
  FrameFollower(const FrameFollower&) = delete;
  FrameFollower& operator=(const FrameFollower&) = delete;

  bool found() const;  ///< whether tf has known the frame

 private:
  struct Listener;  ///< state that tf holds for as long as it calls back
  tf2_ros::Buffer& frames_;
  std::shared_ptr<Listener> listener_;
  boost::signals2::connection connection_;
};

}  // namespace viscera::nodes
