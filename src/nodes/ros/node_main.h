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

/// Caches a parameter that roscpp's first log line requests from the master; the request hangs if the master hangs. The
/// first line must not be one that matters.
inline void readyLog() {
  bool disabled = false;
  ros::param::getCached("/rosout_disable_topics_generation", disabled);
}

/// Runs the body of a node. An error becomes one line of the log and exit status 1.
/// @param body  called with the EndWatch of the process
template <class Body>
int nodeMain(int argc, char** argv, const char* name, Body body) {
  const bool takes_arguments = !ros::isInitialized();  // a second ros::init() has no arguments, and its node name is a
                                                       // different one each time
  const Relaunch launched(argc, argv);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // flushes the log line by line, also into a file or a pipe
  try {
    ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, oneLine(e.what()).c_str());
    return 1;
  }
  const ros::NodeHandle keep_started;  // roscpp and its logging end with the last handle
  readyLog();
  if (takes_arguments) launched.tellInherited();
  int status = 1;
  try {
    EndWatch end;
    try {
      memoryFor(std::string("node ") + name, [&] { body(end); });
      status = 0;
    } catch (const MasterLost&) {  // logged already
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
