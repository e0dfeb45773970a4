// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/obstacle_force_publisher.h"

#include <algorithm>

#include "nodes/ros/conversions.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

ObstacleForcePublisher::ObstacleForcePublisher(ros::NodeHandle& node, const Scene& scene)
    : tissue_frame_(scene.environment.tissue_frame) {
  for (const ObstacleConfig& obstacle : scene.obstacles) {
    publishers_.push_back(node.advertise<geometry_msgs::WrenchStamped>("obstacles/" + obstacle.name + "/force", 1));
  }
}

void ObstacleForcePublisher::publish(const Frame& frame, const ros::Time& stamp) {
  if (frame.tick == tick_) return;
  tick_ = frame.tick;
  for (size_t o = 0; o < std::min(publishers_.size(), frame.obstacle_forces.size()); ++o) {
    if (publishers_[o].getNumSubscribers() == 0) continue;
    publishers_[o].publish(toWrench(frame.obstacle_forces[o], Quaterniond::Identity(), tissue_frame_, stamp));
  }
}

}  // namespace viscera::nodes
