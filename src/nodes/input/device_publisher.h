// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// Publishes what a device driver publishes for a stylus: `<stylus>/measured_cp`, `button1`, `button2` and, for one
/// with jaws, `gripper/measured_js`. Used by nodes that simulate a device.
class DevicePublisher {
 public:
  DevicePublisher(ros::NodeHandle& node, const std::string& stylus);
  /// Returns whether all topics have subscribers.
  bool isReceived() const;
  /// Publishes a pose and the buttons that have changed. With the first pose both buttons are published as released: a
  /// button that is down when tracking begins does nothing. It is pressed with the next pose.
  void send(const StylusSample& sample, const std::string& frame, const ros::Time& stamp);

 private:
  ros::Publisher pose_, button1_, button2_, gripper_;
  bool begun_ = false, button1_down_ = false, button2_down_ = false;
};

}  // namespace viscera::nodes
