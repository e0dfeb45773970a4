// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulated_devices/stylus_joy.h"

#include <ros/console.h>
#include <ros/spinner.h>

namespace viscera::nodes {
namespace {

constexpr const char* kSpaceMouse = "0 1 2 3 4 5";  ///< axes of spacenav_node: x, y, z and rotations about them
constexpr int kMostButtons = 64;

bool isDown(const sensor_msgs::Joy& message, int button) {
  return button >= 0 && static_cast<size_t>(button) < message.buttons.size() &&
         message.buttons[static_cast<size_t>(button)] != 0;
}

int button(Parameters& parameters, const std::string& key, int fallback) {
  return static_cast<int>(parameters.number(key, fallback, -1, kMostButtons - 1));
}

}  // namespace

JoyOptions joyOptions(Parameters& parameters) {
  JoyOptions options;
  options.steering = SteeringOptions::read(parameters);
  const std::string axes = parameters.text("axes", kSpaceMouse);
  options.dead_zone = parameters.number("dead_zone", options.dead_zone, 0, 0.9);
  options.button1 = button(parameters, "button1", options.button1);
  options.button2 = button(parameters, "button2", options.button2);
  options.timeout_s = parameters.number("timeout_s", options.timeout_s, 0.05, 60);
  parameters.refuseOthers();
  try {
    options.axes = AxisMap(axes);
  } catch (const Error& error) {
    throw ParameterError(std::string("parameter ~axes: must be ") + error.what());
  }
  return options;
}

StylusJoy::StylusJoy(const JoyOptions& options)
    : options_(options), device_(node_, options.steering.stylus), pose_(options.steering.start) {
  joy_ = node_.subscribe("joy", 1, &StylusJoy::onJoy, this, ros::TransportHints().tcpNoDelay());
}

void StylusJoy::run() {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  playSteadily(options_.steering, device_, [this](double dt_s) { return next(dt_s); });
}

void StylusJoy::onJoy(const sensor_msgs::Joy& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!options_.axes.fits(message.axes) && !std::exchange(warned_, true))
    ROS_WARN("%s has only %zu axes, but ~axes names others; those count as not deflected", joy_.getTopic().c_str(),
             message.axes.size());
  if (!heard_ || silent_) ROS_INFO("%s moves stylus %s", joy_.getTopic().c_str(), options_.steering.stylus.c_str());
  newest_ = message;
  heard_ = true;
  silent_ = false;
  received_ = std::chrono::steady_clock::now();
}

StylusSample StylusJoy::next(double dt_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!heard_) return {};
  const double silence_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - received_).count();
  if (silence_s > options_.timeout_s) {
    if (!std::exchange(silent_, true))
      ROS_WARN(
          "%s has been silent for %g s: the stylus stops and its buttons are released (joy_node: set ~autorepeat_rate "
          "20)",
          joy_.getTopic().c_str(), options_.timeout_s);
    return {true, pose_, false, false};
  }
  const SteeringOptions& steering = options_.steering;
  const Deflection deflection = options_.axes.deflection(newest_.axes, options_.dead_zone);
  pose_ = within(drive(pose_, deflection, steering.speed, dt_s), steering.start.position_m, steering.reach_m);
  return {true, pose_, isDown(newest_, options_.button1), isDown(newest_, options_.button2)};
}

}  // namespace viscera::nodes
