// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_messages.h"

#include "nodes/ros/conversions.h"

namespace viscera::nodes {

DevicePose toDevicePose(const geometry_msgs::PoseStamped& message) {
  return {fromMessage(message.pose), message.header.frame_id, message.header.stamp};
}

DevicePose toDevicePose(const geometry_msgs::TransformStamped& message) {
  return {fromMessage(message.transform), message.header.frame_id, message.header.stamp};
}

DevicePose toDevicePose(const geometry_msgs::Pose& message, const ros::Time& came) {
  return {fromMessage(message), "", came};
}

}  // namespace viscera::nodes
