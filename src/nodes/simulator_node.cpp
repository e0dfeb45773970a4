// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include "nodes/node_main.h"
#include "nodes/relaunch.h"
#include "nodes/simulator.h"

int main(int argc, char** argv) {
  const viscera::nodes::Relaunch relaunch(argc, argv);  // roscpp takes arguments away
  return viscera::nodes::nodeMain(argc, argv, "simulator", [&relaunch](viscera::nodes::EndWatch& end) {
    relaunch.requireParameters();
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    const auto options = viscera::nodes::simulatorOptions(parameters, ros::package::getPath("viscera"));
    viscera::nodes::Simulator(options, end).run();
  });
}
