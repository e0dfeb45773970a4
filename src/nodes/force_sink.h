// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "nodes/stylus_mailbox.h"
#include "viscera/tools/force_limiter.h"

namespace viscera::nodes {

/// Where a device takes its forces, in the message and the frame that its driver knows.
class ForceSink {
 public:
  ForceSink(ros::NodeHandle& node, const DeviceProfile& device);

  bool hasSubscribers() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  /// @param reaction  on the tip, tissue frame: force, and torque about the tip; not finite becomes zero
  void send(const Reaction& reaction, const DeviceFrame& frame, const ros::Time& stamp);

 private:
  ForceType type_;
  double scale_;
  ros::Publisher publisher_, absolute_;
};

}  // namespace viscera::nodes
