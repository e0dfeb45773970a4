// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/views/surface_messages.h"

namespace viscera::nodes {

/// Publishes topics `surface_topology` (latched), `surface_topology_change`, `surface`, `surface_strain` and
/// `surface_marker`. Every change of the topology is sent at once, as a change. The whole topology is sent again after
/// the time that it takes at kTopologyBytesPerSecond, so a large organ is not sent as a whole in every tick of a cut.
/// It is also sent every kAgain_s, so each part of a bag that is split has one.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame);

  /// Returns the number of subscribers to the moving surface and to its changes. Thread-safe.
  uint32_t viewers() const;
  bool isWanted() const { return viewers() > 0; }
  bool isStrainWanted() const { return strain_.getNumSubscribers() > 0; }
  /// Sends the topology of the uncut surface.
  void start(const std::shared_ptr<const VisibleTopology>& skin, const ros::Time& stamp);
  /// Sends a frame to its subscribers; the topology first, if it has changed.
  void publish(const SurfaceFrame& frame, const ros::Time& stamp);
  /// Returns when to send the whole topology, because it has changed or for a bag; empty if not at all.
  std::optional<std::chrono::steady_clock::time_point> due() const;
  void publishDue();

  static constexpr double kTopologyBytesPerSecond = 3e6;
  static constexpr std::chrono::seconds kAgain_s{5};

 private:
  void changeTopology(const VisibleTopology& topology, const ros::Time& stamp);
  void sendTopology();
  void publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp);

  const std::string frame_;
  ros::Publisher topology_, change_, vertices_, strain_, marker_;
  SentVertices sent_;
  std::vector<bool> wounds_sent_;                       ///< [bodies] whether viewers have a marker of its cut walls
  SurfaceTopology whole_;                               ///< topology of the frames that are sent now
  uint64_t revision_ = 0;                               ///< revision of the surface of that topology
  bool is_sent_ = false;                                ///< whether that topology was sent as a whole
  std::chrono::steady_clock::time_point next_whole_{};  ///< earliest time to send the whole topology
  std::chrono::steady_clock::time_point again_{};       ///< time to send it even if it has not changed
};

}  // namespace viscera::nodes
