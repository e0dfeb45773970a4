// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "nodes/hands/stylus_mailbox.h"
#include "viscera/tools/force_limiter.h"

namespace viscera::nodes {

/// A reaction as a device takes it: along its axes, about the origin of its poses, times its scale, and within what it
/// is made for, whatever the scene's limits have become meanwhile; force and torque shrink by one factor. No torque for
/// one whose messages have none.
/// @param reaction  on the tip, tissue frame: force, and torque about the tip
Reaction toDevice(const Reaction& reaction, const DeviceFrame& frame, const ForcePort& port);

/// Where a device takes its forces, in the message and the frame that its driver knows.
class ForceSink {
 public:
  ForceSink(ros::NodeHandle& node, const DeviceProfile& device);

  bool hasSubscribers() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  /// @param reaction  as of toDevice(); not finite becomes zero   @returns what the device is told
  Reaction send(const Reaction& reaction, const DeviceFrame& frame, const ros::Time& stamp);

 private:
  ForcePort port_;
  ros::Publisher publisher_, absolute_;
};

}  // namespace viscera::nodes
