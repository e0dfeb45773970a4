// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/frame_listener.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <boost/function.hpp>

namespace viscera::nodes {

namespace {
constexpr uint32_t kQueue = 100;      // messages of one topic, as in tf2_ros::TransformListener
constexpr double kWarnPeriod_s = 10;  // of a sender that continues
}  // namespace

void FrameIntake::take(const tf2_msgs::TFMessage& message, const std::string& sender, const ros::Time& now,
                       bool fixed) {
  if (now < last_) {
    ROS_WARN("the clock jumped back by %.3f s; earlier tf frames are discarded", (last_ - now).toSec());
    frames_.clear();  // except static transforms
  }
  last_ = now;
  if (!fixed && !left_out_.empty() && sender == left_out_) return;
  const ros::Duration kept = frames_.getCacheLength();  // a frame further ahead would make all others too old for tf2
  for (const geometry_msgs::TransformStamped& frame : message.transforms) {
    if (!fixed && frame.header.stamp > now + kept) {
      ROS_WARN_THROTTLE(kWarnPeriod_s, "tf frame %s from %s: stamp %.3f s ahead of the clock; accepted: at most %.0f s",
                        frame.child_frame_id.c_str(), sender.c_str(), (frame.header.stamp - now).toSec(), kept.toSec());
      continue;
    }
    try {
      frames_.setTransform(frame, sender, fixed);
    } catch (const tf2::TransformException& error) {
      ROS_ERROR_THROTTLE(kWarnPeriod_s, "tf frame %s from %s: %s", frame.child_frame_id.c_str(), sender.c_str(),
                         error.what());
    }
  }
}

FrameListener::FrameListener(tf2_ros::Buffer& frames, bool own_left_out)
    : intake_(frames, own_left_out ? ros::this_node::getName() : ""), spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  const auto hears = [this](bool fixed) {
    return boost::function<void(const Event&)>([this, fixed](const Event& event) { hear(event, fixed); });
  };
  moving_ = node_.subscribe<tf2_msgs::TFMessage>("/tf", kQueue, hears(false));
  fixed_ = node_.subscribe<tf2_msgs::TFMessage>("/tf_static", kQueue, hears(true));
  frames.setUsingDedicatedThread(true);
  spinner_.start();
}

void FrameListener::hear(const Event& event, bool fixed) {
  intake_.take(*event.getConstMessage(), event.getPublisherName(), ros::Time::now(), fixed);
}

}  // namespace viscera::nodes
