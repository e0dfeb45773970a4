// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include "nodes/forces/wrench_watchdog.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "wrench_watchdog", [](viscera::nodes::EndWatch& end) {
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    const auto options = viscera::nodes::watchdogOptions(parameters, ros::package::getPath("viscera"));
    viscera::nodes::WrenchWatchdog(options, end).run();
  });
}
