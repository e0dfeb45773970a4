// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/master.h>

#include <cstdio>
#include <exception>

#include "nodes/ros/node_main.h"
#include "nodes/simulator/status_watch.h"

int main(int argc, char** argv) {
  try {  // several may run at a time; nodeMain() does not repeat it
    ros::init(argc, argv, "status", ros::init_options::NoSigintHandler | ros::init_options::AnonymousName);
    if (!ros::master::check()) {
      std::printf(
          "no ROS master answers at %s; start one with `roscore` or `roslaunch viscera training.launch`, or set "
          "ROS_MASTER_URI\n",
          ros::master::getURI().c_str());
      return 1;
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "status: %s\n", viscera::oneLine(e.what()).c_str());
    return 1;
  }
  bool found = false;
  const int status = viscera::nodes::nodeMain(argc, argv, "status", [&found](viscera::nodes::EndWatch& end) {
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    found = viscera::nodes::StatusWatch(viscera::nodes::statusOptions(parameters)).run(end);
  });
  return status != 0 || found ? status : 1;
}
