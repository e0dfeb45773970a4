// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

#include <cstdio>
#include <exception>
#include <string>

#include "math/memory_for.h"
#include "math/one_line.h"
#include "nodes/end_watch.h"

namespace viscera::nodes {

/// Runs the body of a node. An error becomes one line and the exit status 1.
/// @param body  takes the EndWatch of the process
template <class Body>
int nodeMain(int argc, char** argv, const char* name, Body body) {
  try {
    ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, oneLine(e.what()).c_str());
    return 1;
  }
  const ros::NodeHandle keep_started;  // roscpp ends with the last handle, and logging with it
  try {
    EndWatch end;
    memoryFor(std::string("node ") + name, [&] { body(end); });
    return 0;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", oneLine(e.what()).c_str());
    return 1;
  }
}

}  // namespace viscera::nodes
