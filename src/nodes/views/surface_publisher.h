// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/views/shown_messages.h"

namespace viscera::nodes {

/// Topics `surface_topology` (latched), `surface_topology_change`, `surface`, `surface_strain` and `surface_marker`.
/// Every change of the topology is sent at once as such; the whole one again when as much time has passed as it takes
/// at kTopologyBytesPerSecond, so that a large organ is not sent whole in every tick of a cut; and every kAgain_s for
/// those who listen, so that each part of a bag that is split has one.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame);

  /// Subscribers of the moving surface, and of what a cut changes of it. From any thread.
  uint32_t viewers() const;
  bool isWanted() const { return viewers() > 0; }
  bool isStrainWanted() const { return strain_.getNumSubscribers() > 0; }
  /// Sends the topology of the whole skin.
  void start(const std::shared_ptr<const ShownTopology>& skin, const ros::Time& stamp);
  /// Sends a frame to whom it may concern; the topology first, if it has changed.
  void publish(const SurfaceFrame& frame, const ros::Time& stamp);
  /// When the whole topology is to be sent that has changed since it last was, or for a bag; none: not at all.
  std::optional<std::chrono::steady_clock::time_point> due() const;
  void publishDue();

  static constexpr double kTopologyBytesPerSecond = 3e6;
  static constexpr std::chrono::seconds kAgain_s{5};

 private:
  void changeTopology(const ShownTopology& topology, const ros::Time& stamp);
  void sendTopology();
  void publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp);

  const std::string frame_;
  ros::Publisher topology_, change_, vertices_, strain_, marker_;
  SentVertices sent_;
  std::vector<bool> wounds_sent_;                       ///< [bodies] viewers have a marker of its wounds
  SurfaceTopology whole_;                               ///< of the frames that are sent now
  uint64_t revision_ = 0;                               ///< of the surface that it was made of
  bool is_sent_ = false;                                ///< ... as a whole
  std::chrono::steady_clock::time_point next_whole_{};  ///< the earliest time at which one may be sent
  std::chrono::steady_clock::time_point again_{};       ///< when it is to be sent though it has not changed
};

}  // namespace viscera::nodes
