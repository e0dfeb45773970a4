// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "devices/steered_hand.h"
#include "nodes/hands/device_publisher.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// What nodes have in common that stand for a device without one: `stylus_marker` and `stylus_joy`.
struct SteeringOptions {
  std::string stylus = "left";
  std::string frame = "tissue";  ///< of the poses
  double rate_hz = 100;
  Pose start;
  double reach_m = 0.2;  ///< the tip stays so near to the start
  SteeredSpeed speed;

  /// ~stylus, ~frame, ~rate_hz, ~start, ~reach_m, ~speed_m_per_s and ~turn_deg_per_s.
  /// @throws ParameterError
  static SteeringOptions read(Parameters& parameters);
};

/// Publishes, at a steady rate of the steady clock, what `next` answers; nothing where that is not valid. Until ROS
/// shuts down.
/// @param next  what the stylus does after another step [s]
/// @throws Error  if the master is lost, or the simulators' scenes have no such stylus
void playSteadily(const SteeringOptions& options, DevicePublisher& device,
                  const std::function<StylusSample(double dt_s)>& next);

}  // namespace viscera::nodes
