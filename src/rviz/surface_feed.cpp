// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface_feed.h"

#include <ros/transport_hints.h>

namespace viscera::rviz_plugin {
namespace {

constexpr uint32_t kChangesQueue = 1000;  // none may be lost: the next whole topology may be half a second away

}  // namespace

void SurfaceFeed::subscribe(ros::NodeHandle& node, const std::string& topic, bool strain) {
  unsubscribe();
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  whole_ = node.subscribe<SurfaceTopology>(
      topic + "_topology", 1, [this](const SurfaceTopologyConstPtr& message) { take(*message); }, {}, hints);
  changes_ = node.subscribe<SurfaceTopologyChange>(
      topic + "_topology_change", kChangesQueue,
      [this](const SurfaceTopologyChangeConstPtr& message) { take(*message); }, {}, hints);
  vertices_ = node.subscribe<SurfaceVertices>(
      topic + (strain ? "_strain" : ""), 1, [this](const SurfaceVerticesConstPtr& message) { take(message); }, {},
      hints);
}

void SurfaceFeed::unsubscribe() {
  whole_.shutdown();
  changes_.shutdown();
  vertices_.shutdown();
  whole_ = changes_ = vertices_ = ros::Subscriber();
}

void SurfaceFeed::clear() {
  surface_.clear();
  wrong_.clear();
}

}  // namespace viscera::rviz_plugin
