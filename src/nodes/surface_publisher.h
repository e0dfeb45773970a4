// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "nodes/conversions.h"

namespace viscera::nodes {

/// Topics `surface_topology` (latched), `surface` and `surface_marker`.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame);

  /// Somebody subscribes to the moving surface. From any thread.
  bool isWanted() const;
  /// Sends the topology of the whole skin.
  void start(SkinLayout&& skin, const ros::Time& stamp);
  /// Sends a frame to whom it may concern; the topology first, if it has changed.
  void publish(const SurfaceFrame& frame, const ros::Time& stamp);

 private:
  void publishTopology(const std::vector<uint32_t>& alive, const ros::Time& stamp);
  void publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp);

  const std::string frame_;
  ros::Publisher topology_, vertices_, marker_;
  SkinLayout skin_;
  std::vector<uint32_t> alive_;
  uint32_t version_ = 0;
};

}  // namespace viscera::nodes
