// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haply/haply_bridge.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "haply_bridge", [](viscera::nodes::EndWatch& end) {
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    viscera::nodes::HaplyBridge(viscera::nodes::haplyOptions(parameters), end).run();
  });
}
