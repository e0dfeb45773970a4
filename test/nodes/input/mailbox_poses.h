// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "nodes/input/stylus_mailbox.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera::nodes {

// Inputs for tests of StylusMailbox, with times in seconds since their beginning.

constexpr double kBegin_s = 100;       // in ROS time
constexpr double kRounding_m = 1e-12;  // double rounding of a rotation and a sum
inline const SteadyTime kStart = std::chrono::steady_clock::now();

inline SteadyTime at(double time_s) {
  return kStart + std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(time_s));
}

inline StylusConfig config() {
  StylusConfig config;
  config.stale_after_s = 0.2;
  config.workspace_m = 1;
  return config;
}

inline DevicePose poseAt(double x_m, const std::string& frame = "tissue") {
  return {{{x_m, 0, 0}, Quaterniond::Identity()}, frame, ros::Time(kBegin_s)};
}

inline FramePose nowhere(const std::string&) {
  return {};
}

/// Returns an arrival; both clocks advance together.
inline Arrival arrival(double time_s) {
  return {at(time_s), ros::Time(kBegin_s + time_s)};
}

/// Returns a valid pose, stamped on arrival.
inline DevicePose poseNow(double time_s) {
  DevicePose message = poseAt(0.1);
  message.stamp = ros::Time(kBegin_s + time_s);
  return message;
}

}  // namespace viscera::nodes
