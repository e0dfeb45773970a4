// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// What a device driver publishes of a stylus: `<stylus>/measured_cp`, `button1`, `button2` and, of one with jaws,
/// `gripper/measured_js`. For nodes that stand for a device.
class DevicePublisher {
 public:
  DevicePublisher(ros::NodeHandle& node, const std::string& stylus);
  /// All of it has listeners.
  bool isHeard() const;
  /// A pose, and those buttons that have changed. With the first pose both are let go: one that is down when the hand
  /// comes does nothing, and is pressed with the next.
  void send(const StylusSample& sample, const std::string& frame, const ros::Time& stamp);

 private:
  ros::Publisher pose_, button1_, button2_, gripper_;
  bool begun_ = false, button1_down_ = false, button2_down_ = false;
};

}  // namespace viscera::nodes
