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

/// Publishes topic `tick`, with which other nodes follow simulated time. It is sent at once and does not wait for
/// images.
class TickPublisher {
 public:
  /// @param viewed  returns whether the simulator's output has a viewer
  TickPublisher(ros::NodeHandle& node, const Scene& scene, std::function<bool()> viewed);
  /// Publishes a tick. Called after every tick, and while paused. @param tick  since the start or the last reset
  void publish(uint64_t tick);

 private:
  const std::function<bool()> viewed_;
  Tick tick_;  ///< last tick that was sent
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
