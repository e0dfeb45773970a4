// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "nodes/conversions.h"

namespace viscera::nodes {

/// Topics `surface_topology` (latched), `surface` and `surface_marker`.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame);

  /// Subscribers of the moving surface, and of what a cut changes of it. From any thread.
  uint32_t viewers() const;
  bool isWanted() const { return viewers() > 0; }
  /// Sends the topology of the whole skin.
  void start(const std::shared_ptr<const ShownTopology>& skin, const ros::Time& stamp);
  /// Sends a frame to whom it may concern; the topology first, if it has changed.
  void publish(const SurfaceFrame& frame, const ros::Time& stamp);

 private:
  void publishTopology(const ShownTopology& topology, const ros::Time& stamp);
  void publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp);

  const std::string frame_;
  ros::Publisher topology_, vertices_, marker_;
  SentVertices sent_;
  std::vector<bool> wounds_sent_;  ///< [bodies] viewers have a marker of its wounds
  uint64_t revision_ = 0;          ///< of the topology sent last
  uint32_t version_ = 0;           ///< how many were sent
};

}  // namespace viscera::nodes
