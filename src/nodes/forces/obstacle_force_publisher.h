// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "viscera/session/frame.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Topics `obstacles/<name>/force`: what the tissue does to each obstacle, tick by tick.
class ObstacleForcePublisher {
 public:
  ObstacleForcePublisher(ros::NodeHandle& node, const Scene& scene);
  /// Sends what a tick measured; once, however often its frame comes. @param stamp  of the tick
  void publish(const Frame& frame, const ros::Time& stamp);

 private:
  const std::string tissue_frame_;
  std::vector<ros::Publisher> publishers_;  ///< [obstacles]
  uint64_t tick_ = 0;                       ///< that was sent last
};

}  // namespace viscera::nodes
