// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>

#include "nodes/stylus_mailbox.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// What goes back to a stylus: `<stylus>/body/servo_cf`, its companion for orientation, and the frame `<stylus>_tool`.
class StylusPublisher {
 public:
  StylusPublisher(ros::NodeHandle& node, const StylusMailbox& mailbox, const std::string& tissue_frame,
                  const std::string& frame_prefix);
  void publish(const Reaction& reaction, const StylusSample& sample, const ros::Time& stamp);

 private:
  const StylusMailbox& mailbox_;
  const std::string tissue_frame_, tool_frame_;
  ros::Publisher force_, absolute_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Time last_transform_;
};

}  // namespace viscera::nodes
