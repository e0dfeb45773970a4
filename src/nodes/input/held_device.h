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

/// Returns the device from the private parameters of node `sim_device`, without those of the replay.
SimulatedDeviceConfig simulatedDevice(Parameters& parameters);

/// A simulated haptic device that a user holds. It is driven by the user's intended motion and by the force on
/// `<stylus>/body/servo_cf`; both determine the pose that it reports. Forces and poses are in the same frame.
class HeldDevice {
 public:
  HeldDevice(ros::NodeHandle& node, const std::string& stylus, const SimulatedDeviceConfig& config);
  HeldDevice(const HeldDevice&) = delete;
  HeldDevice& operator=(const HeldDevice&) = delete;

  /// Advances the device to the current time.
  /// @param intended  pose that the user aims for   @returns pose by the encoders
  Pose follow(const Pose& intended);
  /// Returns one line with energy and number of wrenches.
  std::string summary();

 private:
  using Clock = std::chrono::steady_clock;
  void feel(const geometry_msgs::WrenchStamped& message);
  Vector3d force(Clock::time_point now);

  const std::string stylus_;
  const SimulatedDeviceConfig config_;
  std::optional<SimulatedDevice> device_;  ///< empty before the first pose
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
