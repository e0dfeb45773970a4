// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "nodes/ros/parameters.h"
#include "viscera/haptics/simulated_device.h"
#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// The private parameters of node `sim_device` that are not those of a replay.
SimulatedDeviceConfig simulatedDevice(Parameters& parameters);

/// A simulated device between what a hand intends and what is told of it: it feels `<stylus>/body/servo_cf`, and where
/// it gets to is where that force and the hand let it. Forces and poses are in one frame.
class HeldDevice {
 public:
  HeldDevice(ros::NodeHandle& node, const std::string& stylus, const SimulatedDeviceConfig& config);
  HeldDevice(const HeldDevice&) = delete;
  HeldDevice& operator=(const HeldDevice&) = delete;

  /// Goes on to now. @param intended  where the hand wants to be   @returns what the encoders say
  Pose follow(const Pose& intended);
  /// One line: energy, wrenches.
  std::string summary();

 private:
  using Clock = std::chrono::steady_clock;
  void feel(const geometry_msgs::WrenchStamped& message);
  Vector3d force(Clock::time_point now);

  const std::string stylus_;
  const SimulatedDeviceConfig config_;
  std::optional<SimulatedDevice> device_;  ///< from the first pose on
  Vector3d intended_m_ = Vector3d::Zero();
  Clock::time_point stepped_{};
  double least_j_ = 0;

  std::mutex mutex_;
  Vector3d force_n_ = Vector3d::Zero();
  Clock::time_point heard_{};
  uint64_t wrenches_ = 0;
  ros::Subscriber force_;
};

}  // namespace viscera::nodes
