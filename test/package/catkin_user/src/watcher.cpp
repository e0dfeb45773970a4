// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Steps a session of the library, then waits for a simulator's surface and answers with a message of its own.
#include <ros/ros.h>
#include <viscera/SurfaceVertices.h>
#include <viscera_user/Watched.h>

#include <iostream>

#include "viscera/session/session.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "watcher");
  viscera::Session session(viscera::loadScene("practice_pad"));
  session.step(viscera::StylusSamples(), viscera::FrameRequest());
  ros::NodeHandle node;
  viscera_user::Watched watched;
  const ros::Subscriber surface =
      node.subscribe<viscera::SurfaceVertices>("surface", 1, [&watched](const viscera::SurfaceVertices::ConstPtr&) {
        watched.tick.tick += 1;
        std::cout << "watched " << watched.tick.tick << std::endl;
        ros::shutdown();
      });
  ros::spin();
  return watched.tick.tick > 0 ? 0 : 1;
}
