// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/held_topics.h"

#include <ros/node_handle.h>
#include <ros/publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>

#include <string>

namespace viscera::nodes {

/// roscpp counts the publishers of a topic; only the first and the last contact the master.
HeldTopics::HeldTopics() {
  std::vector<std::string> names;
  ros::this_node::getAdvertisedTopics(names);
  ros::NodeHandle node;
  for (const std::string& name : names) {
    const ros::PublicationPtr there = ros::TopicManager::instance()->lookupPublication(name);
    if (!there) continue;  // it has ended concurrently
    ros::AdvertiseOptions options(name, 1, there->getMD5Sum(), there->getDataType(), there->getMessageDefinition());
    publishers_.push_back(node.advertise(options));
  }
}

}  // namespace viscera::nodes
