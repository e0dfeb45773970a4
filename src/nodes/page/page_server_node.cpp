// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/page_server.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  return viscera::nodes::nodeMain(argc, argv, "page_server", [](viscera::nodes::EndWatch& end) {
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    viscera::nodes::PageServer(viscera::nodes::pageServerOptions(parameters)).run(end);
  });
}
