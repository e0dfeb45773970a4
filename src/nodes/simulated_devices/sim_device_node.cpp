// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include "nodes/ros/node_main.h"
#include "nodes/ros/relaunch.h"
#include "nodes/ros/thread_schedule.h"
#include "nodes/simulated_devices/stylus_replay.h"

int main(int argc, char** argv) {
  const viscera::nodes::Relaunch relaunch(argc, argv);  // roscpp removes arguments
  return viscera::nodes::nodeMain(argc, argv, "sim_device", [&relaunch](viscera::nodes::EndWatch& end) {
    const viscera::nodes::EndWatch::Act stop(end, [] { ros::requestShutdown(); });
    relaunch.requireParameters();
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    const auto options = viscera::nodes::simDeviceOptions(parameters, ros::package::getPath("viscera"));
    ROS_INFO("a device of %g kg at %g Hz; its loop: %s", options.device->mass_kg, options.rate_hz,
             viscera::nodes::goFirst(options.priority).c_str());
    viscera::nodes::StylusReplay(options).run();
  });
}
