// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/held_device.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "math/number_text.h"

namespace viscera::nodes {
namespace {

/// Silence after which the motors stop, as a driver should implement it.
constexpr std::chrono::milliseconds kSilence{50};
/// A loop that was delayed for more periods than this does not catch up.
constexpr int kMostPeriods = 50;

}  // namespace

SimulatedDeviceConfig simulatedDevice(Parameters& parameters) {
  SimulatedDeviceConfig config;
  config.mass_kg = parameters.number("mass_kg", config.mass_kg, 0.01, 100);
  config.damping_n_s_per_m = parameters.number("damping_n_s_per_m", config.damping_n_s_per_m, 0, 1000);
  config.hand_stiffness_n_per_m = parameters.number("hand_stiffness_n_per_m", config.hand_stiffness_n_per_m, 0, 1e5);
  config.hand_damping_n_s_per_m = parameters.number("hand_damping_n_s_per_m", config.hand_damping_n_s_per_m, 0, 1000);
  config.tremor_m = parameters.number("tremor_m", config.tremor_m, 0, 0.01);
  config.delay_s = parameters.number("device_delay_s", config.delay_s, 0, 0.1);
  config.encoder_m = parameters.number("encoder_m", config.encoder_m, 0, 0.01);
  config.most_force_n = parameters.number("most_force_n", config.most_force_n, 0, 1000);
  return config;
}

HeldDevice::HeldDevice(ros::NodeHandle& node, const std::string& stylus, const SimulatedDeviceConfig& config)
    : stylus_(stylus),
      config_(config),
      force_(
          node.subscribe(stylus + "/body/servo_cf", 1, &HeldDevice::feel, this, ros::TransportHints().tcpNoDelay())) {}

void HeldDevice::feel(const geometry_msgs::WrenchStamped& message) {
  const auto& force = message.wrench.force;
  const std::lock_guard<std::mutex> lock(mutex_);
  force_n_ = Vector3d(force.x, force.y, force.z);
  heard_ = Clock::now();
  ++wrenches_;
}

Vector3d HeldDevice::force(Clock::time_point now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return now - heard_ < kSilence ? force_n_ : Vector3d::Zero();
}

Pose HeldDevice::follow(const Pose& intended) {
  const Clock::time_point now = Clock::now();
  if (!device_) {
    device_.emplace(config_, intended.position_m);
    intended_m_ = intended.position_m;
    stepped_ = now;
  }
  const double since_s = std::chrono::duration<double>(now - stepped_).count();
  const int periods = static_cast<int>(std::lround(since_s / config_.period_s));
  const int made = std::min(periods, kMostPeriods);
  const Vector3d from_m = intended_m_, force_n = force(now);
  for (int i = 1; i <= made; ++i) {
    device_->step(force_n, from_m + static_cast<double>(i) / made * (intended.position_m - from_m));
    least_j_ = std::min(least_j_, device_->energy_j());
  }
  if (made > 0) intended_m_ = intended.position_m;
  stepped_ = made < periods ? now
                            : stepped_ + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(made * config_.period_s));
  return {device_->measured_m(), intended.orientation};
}

std::string HeldDevice::summary() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stylus_ + ": " + std::to_string(wrenches_) + " wrenches, the motors took " +
         fixedText(device_ ? 1e3 * device_->energy_j() : 0, 3) + " mJ in, " + fixedText(1e3 * least_j_, 3) +
         " mJ at least";
}

}  // namespace viscera::nodes
