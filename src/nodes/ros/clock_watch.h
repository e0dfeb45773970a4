// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <chrono>

namespace viscera::nodes {

/// Says once that ROS time does not run although others were told to wait for it.
class ClockWatch {
 public:
  /// Call from time to time.
  void check() {
    constexpr std::chrono::seconds kPatience{3};  // a /clock that is on its way
    if (said_ || !ros::Time::isSimTime() || !ros::Time::now().isZero()) return;
    if (std::chrono::steady_clock::now() - started_ < kPatience) return;
    said_ = true;
    ROS_WARN(
        "use_sim_time is true and nothing comes on /clock: stamps are zero, which other nodes take for invalid, and no "
        "pose with such a stamp is used. Start what publishes /clock, or: rosparam set use_sim_time false, and start "
        "the nodes again");
  }

 private:
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  bool said_ = false;
};

}  // namespace viscera::nodes
