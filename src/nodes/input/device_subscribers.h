// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {

/// Callback for a pose. @param sender  name of the node that sent it
using PoseReceived = std::function<void(const DevicePose& pose, const std::string& sender)>;
using ButtonsReceived = std::function<void(const std::vector<int32_t>& values)>;

/// Subscribes to poses of the type that a profile names. @param port  port of a topic, neither of tf nor of an arm
ros::Subscriber listenToPoses(ros::NodeHandle& node, const PosePort& port, uint32_t queue, const PoseReceived& heard);
/// Subscribes to the message of a button. @returns an empty subscriber if the profile has no such button
ros::Subscriber listenToButtons(ros::NodeHandle& node, const ButtonPort& port, const ButtonsReceived& heard);

}  // namespace viscera::nodes
