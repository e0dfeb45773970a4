// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nodes/hands/stylus_mailbox.h"

namespace viscera::nodes {

/// @param sender  name of the node that sent it
using PoseHeard = std::function<void(const DevicePose& pose, const std::string& sender)>;
using ButtonsHeard = std::function<void(const std::vector<int32_t>& values)>;

/// Listens to poses of the type that a profile names. @param port  of a topic: neither of tf nor of an arm
ros::Subscriber listenToPoses(ros::NodeHandle& node, const PosePort& port, uint32_t queue, const PoseHeard& heard);
/// Listens to the message that a button is in. @returns an empty subscriber where there is no such button
ros::Subscriber listenToButtons(ros::NodeHandle& node, const ButtonPort& port, const ButtonsHeard& heard);

}  // namespace viscera::nodes
