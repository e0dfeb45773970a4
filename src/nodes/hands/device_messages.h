// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include "nodes/hands/stylus_mailbox.h"

namespace viscera::nodes {

// What drivers send, as a DevicePose; nothing is checked here.

DevicePose toDevicePose(const geometry_msgs::PoseStamped& message);
DevicePose toDevicePose(const geometry_msgs::TransformStamped& message);
/// @param came  when it did: it says neither when nor in which frame it is true
DevicePose toDevicePose(const geometry_msgs::Pose& message, const ros::Time& came);

}  // namespace viscera::nodes
