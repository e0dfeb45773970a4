// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include <cstdio>
#include <string>
#include <vector>

#include "nodes/input/device_check.h"
#include "nodes/ros/node_main.h"

int main(int argc, char** argv) {
  using namespace viscera::nodes;
  std::vector<std::string> arguments(argv, argv + argc);
  DeviceCheckOptions options;
  try {
    options = takeArguments(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "device_check: %s\n", viscera::oneLine(e.what()).c_str());
    return 1;
  }
  std::vector<char*> others;
  for (std::string& text : arguments) others.push_back(text.data());
  others.push_back(nullptr);
  bool done = false;
  const int status = nodeMain(static_cast<int>(others.size()) - 1, others.data(), "device_check", [&](EndWatch& end) {
    auto parameters = Parameters::ofThisNode();
    readParameters(parameters, options);
    options.package_folder = ros::package::getPath("viscera");
    done = DeviceCheck(options).run(end);
  });
  return status != 0 || done ? status : 1;
}
