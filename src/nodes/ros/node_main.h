// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/param.h>

#include <cstdio>
#include <exception>
#include <string>

#include "math/memory_for.h"
#include "math/one_line.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/relaunch.h"

namespace viscera::nodes {

/// The first line of roscpp's log asks the master for this parameter, and waits for ever where that hangs; later ones
/// know it. No line that matters is to be the first.
inline void readyLog() {
  bool disabled = false;
  ros::param::getCached("/rosout_disable_topics_generation", disabled);
}

/// Runs the body of a node. An error becomes one line and the exit status 1.
/// @param body  takes the EndWatch of the process
template <class Body>
int nodeMain(int argc, char** argv, const char* name, Body body) {
  const bool takes_arguments = !ros::isInitialized();  // else they are gone, and the name is new each time
  const Relaunch launched(argc, argv);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // lines of the log come as they are said, into a file or a pipe too
  try {
    ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, oneLine(e.what()).c_str());
    return 1;
  }
  const ros::NodeHandle keep_started;  // roscpp ends with the last handle, and logging with it
  readyLog();
  if (takes_arguments) launched.tellInherited();
  int status = 1;
  try {
    EndWatch end;
    try {
      memoryFor(std::string("node ") + name, [&] { body(end); });
      status = 0;
    } catch (const MasterLost&) {  // which was said
    } catch (const std::exception& e) {
      ROS_FATAL("%s", oneLine(e.what()).c_str());
    }
    EndWatch::begin(status);
    ros::shutdown();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", oneLine(e.what()).c_str());
  }
  return status;
}

}  // namespace viscera::nodes
