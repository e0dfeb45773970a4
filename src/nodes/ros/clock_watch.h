// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <chrono>

namespace viscera::nodes {

/// Warns once if ROS time does not advance although nodes use simulated time.
class ClockWatch {
 public:
  /// Checks the clock. Call it at intervals.
  void check() {
    constexpr std::chrono::seconds kPatience{3};  // allows for the first /clock message
    if (said_ || !ros::Time::isSimTime() || !ros::Time::now().isZero()) return;
    if (std::chrono::steady_clock::now() - started_ < kPatience) return;
    said_ = true;
    ROS_WARN(
        "use_sim_time is true, but nothing is published on /clock: stamps are zero, which is invalid, and no pose with "
        "such a stamp is used. Start the publisher of /clock, or run `rosparam set use_sim_time false` and restart "
        "the nodes");
  }

 private:
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  bool said_ = false;
};

}  // namespace viscera::nodes
