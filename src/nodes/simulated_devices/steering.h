// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "devices/steered_tool.h"
#include "nodes/input/device_publisher.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// Options that `stylus_marker` and `stylus_joy` share, which replace a device.
struct SteeringOptions {
  std::string stylus = "left";
  std::string frame = "tissue";  ///< frame of the poses
  double rate_hz = 100;
  Pose start;
  double reach_m = 0.2;  ///< largest distance of the tip from the start [m]
  SteeredSpeed speed;

  /// Reads ~stylus, ~frame, ~rate_hz, ~start, ~reach_m, ~speed_m_per_s and ~turn_deg_per_s.
  /// @throws ParameterError
  static SteeringOptions read(Parameters& parameters);
};

/// Publishes the samples of `next` at a steady rate of the steady clock, and nothing for an invalid sample. Runs until
/// ROS shuts down.
/// @param next  returns the sample of the stylus after another step [s]
/// @throws Error  if the master is lost, or the simulators' scenes have no such stylus
void playSteadily(const SteeringOptions& options, DevicePublisher& device,
                  const std::function<StylusSample(double dt_s)>& next);

}  // namespace viscera::nodes
