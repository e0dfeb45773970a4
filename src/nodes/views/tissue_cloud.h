// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "export/node_loads.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// Converts loads to a cloud with the fields x, y, z, strain and force, all float32.
sensor_msgs::PointCloud2 toCloud(const std::vector<NodeLoad>& loads, const std::string& frame, const ros::Time& stamp);

/// Publishes topic `tissue_cloud`: strain and force at the nodes of tissue. It reads the state, which waits for the
/// GPU, and computes the stress of every cell, so it is sent at most five times a second.
class TissueCloud {
 public:
  TissueCloud(ros::NodeHandle& node, const std::string& frame);
  bool isWanted() const { return publisher_.getNumSubscribers() > 0; }  ///< thread-safe
  /// Returns whether a cloud is due. On the simulation thread, as messageOf().
  bool isDue();
  sensor_msgs::PointCloud2 messageOf(const Session& session, const ros::Time& stamp);
  void publish(const sensor_msgs::PointCloud2& cloud) { publisher_.publish(cloud); }

 private:
  const std::string frame_;
  ros::Publisher publisher_;
  std::unique_ptr<NodeLoads> loads_;  ///< of the session's model
  std::chrono::steady_clock::time_point due_{};
};

}  // namespace viscera::nodes
