// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_record.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "stylus_record", [](viscera::nodes::EndWatch& end) {
    const viscera::nodes::EndWatch::Act stop(end, [] { ros::requestShutdown(); });
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    viscera::nodes::StylusRecord(viscera::nodes::recordOptions(parameters)).run();
  });
}
