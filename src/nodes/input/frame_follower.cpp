// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/frame_follower.h"

#include <utility>

namespace viscera::nodes {

struct FrameFollower::Listener {
  Listener(tf2_ros::Buffer& frames, const std::string& base, const std::string& frame, Heard heard)
      : frames(frames), base(base), frame(frame), heard(std::move(heard)) {}

  void update() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (ended) return;
    try {
      const geometry_msgs::TransformStamped newest = frames.lookupTransform(base, frame, ros::Time(0));
      if (found && newest.header.stamp == stamp) return;  // other frames have moved
      stamp = newest.header.stamp;
      found = true;
      heard(newest);
    } catch (const tf2::TransformException&) {
    }
  }

  tf2_ros::Buffer& frames;
  const std::string base, frame;
  const Heard heard;
  std::mutex mutex;
  bool ended = false, found = false;
  ros::Time stamp;
};

FrameFollower::FrameFollower(tf2_ros::Buffer& frames, const std::string& base, const std::string& frame, Heard heard)
    : frames_(frames), listener_(std::make_shared<Listener>(frames, base, frame, std::move(heard))) {
  connection_ = frames_._addTransformsChangedListener([listener = listener_] { listener->update(); });
}

FrameFollower::~FrameFollower() {
  frames_._removeTransformsChangedListener(connection_);
  const std::lock_guard<std::mutex> lock(listener_->mutex);
  listener_->ended = true;
}

bool FrameFollower::found() const {
  const std::lock_guard<std::mutex> lock(listener_->mutex);
  return listener_->found;
}

}  // namespace viscera::nodes
