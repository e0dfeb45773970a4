// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulated_devices/steering.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "nodes/input/stylus_check.h"
#include "nodes/ros/clock_watch.h"
#include "nodes/ros/master_watch.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kRadPerDeg = 3.14159265358979323846 / 180;
constexpr double kLongestStepS = 0.1;  ///< longest step [s]; a delayed thread does not make the tip jump
constexpr double kBeside_m = 0.04;     ///< offset of a stylus from the centre [m]: two start next to each other
constexpr double kAbove_m = 0.12;      ///< height over the tissue frame's origin [m], outside an organ of a hand's size

}  // namespace

SteeringOptions SteeringOptions::read(Parameters& parameters) {
  SteeringOptions options;
  options.stylus = parameters.text("stylus", options.stylus);
  options.frame = parameters.text("frame", options.frame);
  options.rate_hz = parameters.number("rate_hz", options.rate_hz, 10, 1000);
  const double beside_m = options.stylus == "left" ? -kBeside_m : kBeside_m;
  const auto start = parameters.numbers("start", {beside_m, 0, kAbove_m, 0, 0, 0}, -360, 360);
  options.start = {{start[0], start[1], start[2]}, rotationFromDegrees({start[3], start[4], start[5]})};
  options.reach_m = parameters.number("reach_m", options.reach_m, 0.001, 100);
  options.speed.linear_m_per_s = parameters.number("speed_m_per_s", options.speed.linear_m_per_s, 0.001, 10);
  options.speed.angular_rad_per_s = kRadPerDeg * parameters.number("turn_deg_per_s", 90, 1, 3600);
  if (options.stylus.empty()) throw ParameterError("parameter ~stylus: must name a stylus of the scene");
  return options;
}

void playSteadily(const SteeringOptions& options, DevicePublisher& device,
                  const std::function<StylusSample(double dt_s)>& next) {
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options.rate_hz));
  MasterWatch master;
  ClockWatch clock;
  ros::NodeHandle node;
  StylusCheck known(node, options.stylus);
  Clock::time_point before = Clock::now(), due = before;
  while (ros::ok()) {
    master.require();
    clock.check();
    known.require();
    const Clock::time_point now = Clock::now();
    const double dt_s = std::min(std::chrono::duration<double>(now - before).count(), kLongestStepS);
    before = now;
    const StylusSample sample = next(dt_s);
    const ros::Time stamp = ros::Time::now();
    if (sample.valid && !stamp.isZero()) device.send(sample, options.frame, stamp);
    due = std::max(due + period, now);  // a delayed node does not catch up with a burst
    std::this_thread::sleep_until(due);
  }
}

}  // namespace viscera::nodes
