// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include "nodes/ros/node_main.h"
#include "nodes/ros/relaunch.h"
#include "nodes/simulated_devices/stylus_replay.h"

int main(int argc, char** argv) {
  const viscera::nodes::Relaunch relaunch(argc, argv);  // roscpp removes arguments
  return viscera::nodes::nodeMain(argc, argv, "stylus_replay", [&relaunch](viscera::nodes::EndWatch& end) {
    const viscera::nodes::EndWatch::Act stop(end, [] { ros::requestShutdown(); });
    relaunch.requireParameters();
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    const auto options = viscera::nodes::replayOptions(parameters, ros::package::getPath("viscera"));
    viscera::nodes::StylusReplay(options).run();
  });
}
