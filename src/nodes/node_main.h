// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

#include <cstdio>
#include <exception>

#include "math/one_line.h"

namespace viscera::nodes {

/// Runs the body of a node. An error becomes one line and the exit status 1.
template <class Body>
int nodeMain(int argc, char** argv, const char* name, Body body) {
  try {
    ros::init(argc, argv, name);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, oneLine(e.what()).c_str());
    return 1;
  }
  const ros::NodeHandle keep_started;  // roscpp ends with the last handle, and logging with it
  try {
    body();
    return 0;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", oneLine(e.what()).c_str());
    return 1;
  }
}

}  // namespace viscera::nodes
