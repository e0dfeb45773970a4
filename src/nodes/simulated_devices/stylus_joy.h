// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>

#include <chrono>
#include <mutex>
#include <string>

#include "nodes/simulated_devices/steering.h"

namespace viscera::nodes {

/// The private parameters of `stylus_joy`.
struct JoyOptions {
  SteeringOptions steering;
  AxisMap axes{"none none none none none none"};
  double dead_zone = 0.1;
  int button1 = 0, button2 = 1;  ///< index of the button in the message; -1: none
  double timeout_s = 0.5;        ///< silence after which the tip stops and buttons are released [s]
};
/// Reads the private parameters. @throws ParameterError
JoyOptions joyOptions(Parameters& parameters);

/// A gamepad or space mouse as a stylus: axes of sensor_msgs/Joy are velocities of the tip.
class StylusJoy {
 public:
  explicit StylusJoy(const JoyOptions& options);
  /// Runs until ROS shuts down; the stylus is tracked from the first message on.
  /// @throws Error  if the master is lost
  void run();

 private:
  void onJoy(const sensor_msgs::Joy& message);
  StylusSample next(double dt_s);

  const JoyOptions options_;
  ros::NodeHandle node_;
  DevicePublisher device_;
  std::mutex mutex_;
  sensor_msgs::Joy newest_;
  bool heard_ = false, silent_ = false, warned_ = false;
  SteadyTime received_{};
  Pose pose_;
  ros::Subscriber joy_;
};

}  // namespace viscera::nodes
