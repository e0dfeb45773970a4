// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {

// Messages of drivers, converted to DevicePose without checks.

DevicePose toDevicePose(const geometry_msgs::PoseStamped& message);
DevicePose toDevicePose(const geometry_msgs::TransformStamped& message);
/// Converts a message that has neither stamp nor frame. @param came  time of arrival
DevicePose toDevicePose(const geometry_msgs::Pose& message, const ros::Time& came);

}  // namespace viscera::nodes
