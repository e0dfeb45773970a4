// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <mutex>

#include "nodes/ros/simulated_time.h"
#include "viscera/Tick.h"

namespace viscera::nodes {

/// The time of the simulator in this namespace, from its topic `tick`; the steady clock if there is no such topic.
class SimulationClock {
 public:
  /// Requires a spinner.
  explicit SimulationClock(ros::NodeHandle& node);

  /// Returns the time since the last call, or since the start [s].
  double take();
  /// Returns whether the simulator's output has a viewer.
  bool isViewed() const;

 private:
  using Clock = std::chrono::steady_clock;
  void onTick(const Tick& tick);

  mutable std::mutex mutex_;
  SimulatedTime simulated_;
  bool viewed_ = false;
  double taken_simulated_s_ = 0;
  Clock::time_point taken_;
  ros::Subscriber ticks_;
};

}  // namespace viscera::nodes
