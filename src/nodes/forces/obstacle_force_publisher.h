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

/// Publishes the force of the tissue on each obstacle after every tick, on topics `obstacles/<name>/force`.
class ObstacleForcePublisher {
 public:
  ObstacleForcePublisher(ros::NodeHandle& node, const Scene& scene);
  /// Publishes the forces that a tick measured. A tick is sent once, even if its frame comes again.
  /// @param stamp  of the tick
  void publish(const Frame& frame, const ros::Time& stamp);

 private:
  const std::string tissue_frame_;
  std::vector<ros::Publisher> publishers_;  ///< [obstacles]
  uint64_t tick_ = 0;                       ///< last tick that was sent
};

}  // namespace viscera::nodes
