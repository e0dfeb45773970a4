// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <functional>

#include "viscera/Tick.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Topic `tick`, by which others keep pace with the simulation. Sent at once, behind no picture.
class TickPublisher {
 public:
  /// @param viewed  someone looks at what the simulator shows
  TickPublisher(ros::NodeHandle& node, const Scene& scene, std::function<bool()> viewed);
  /// After every tick, and while paused. @param tick  since the start or the last reset
  void publish(uint64_t tick);

 private:
  const std::function<bool()> viewed_;
  Tick tick_;  ///< the last that was sent
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
