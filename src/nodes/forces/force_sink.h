// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "nodes/input/stylus_mailbox.h"
#include "viscera/tools/force_limiter.h"

namespace viscera::nodes {

/// Returns the reaction as a device takes it: along the device's axes, about the origin of its poses, multiplied by its
/// scale. One factor scales force and torque down to the limits of the device, independently of the scene's current
/// limits. The torque is zero if the device's messages have none.
/// @param reaction  force on the tip and torque about the tip, tissue frame
Reaction toDevice(const Reaction& reaction, const DeviceFrame& frame, const ForcePort& port);

/// Publishes forces for one device, in the message type and frame that its driver expects.
class ForceSink {
 public:
  ForceSink(ros::NodeHandle& node, const DeviceProfile& device);

  bool hasSubscribers() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  /// Publishes a reaction. @param reaction  see toDevice(); zero is sent if it is not finite   @returns what was sent
  Reaction send(const Reaction& reaction, const DeviceFrame& frame, const ros::Time& stamp);

 private:
  ForcePort port_;
  ros::Publisher publisher_, absolute_;
};

}  // namespace viscera::nodes
