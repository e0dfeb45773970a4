// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include "nodes/input/register_stylus.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "register_stylus", [](viscera::nodes::EndWatch& end) {
    const viscera::nodes::EndWatch::Act stop(end, [] { ros::requestShutdown(); });
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    viscera::nodes::RegisterStylus(viscera::nodes::registerOptions(parameters, ros::package::getPath("viscera"))).run();
  });
}
