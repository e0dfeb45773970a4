// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/node_main.h"
#include "nodes/simulated_devices/stylus_marker.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "stylus_marker", [](viscera::nodes::EndWatch& end) {
    const viscera::nodes::EndWatch::Act stop(end, [] { ros::requestShutdown(); });
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    viscera::nodes::StylusMarker(viscera::nodes::markerOptions(parameters)).run();
  });
}
