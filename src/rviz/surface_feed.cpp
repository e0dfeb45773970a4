// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface_feed.h"

#include <ros/transport_hints.h>

#include <algorithm>
#include <utility>

namespace viscera::rviz_plugin {
namespace {

constexpr uint32_t kChangesQueue = 1000;  // none may be lost: the next whole topology may be half a second away

}  // namespace

void SurfaceFeed::subscribe(ros::NodeHandle& node, const std::string& topic, bool strain) {
  unsubscribe();
  node_ = node;
  topic_ = topic;
  strain_ = strain;
  connect();
  watch_.follow(vertices_.getTopic());
}

void SurfaceFeed::connect() {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  whole_ = node_.subscribe<SurfaceTopology>(
      topic_ + "_topology", 1, [this](const SurfaceTopologyConstPtr& message) { take(*message); }, {}, hints);
  changes_ = node_.subscribe<SurfaceTopologyChange>(
      topic_ + "_topology_change", kChangesQueue,
      [this](const SurfaceTopologyChangeConstPtr& message) { take(*message); }, {}, hints);
  vertices_ = node_.subscribe<SurfaceVertices>(
      topic_ + (strain_ ? "_strain" : ""), 1, [this](const SurfaceVerticesConstPtr& message) { take(message); }, {},
      hints);
}

void SurfaceFeed::unsubscribe() {
  whole_.shutdown();
  changes_.shutdown();
  vertices_.shutdown();
  whole_ = changes_ = vertices_ = ros::Subscriber();
  watch_.follow("");
  senders_.clear();
}

bool SurfaceFeed::renew() {
  std::set<std::string> alive = watch_.senders().alive;
  if (alive.empty()) return false;
  const bool replaced = !std::includes(alive.begin(), alive.end(), senders_.begin(), senders_.end());
  senders_ = std::move(alive);
  if (!replaced) return false;
  clear();
  connect();
  return true;
}

void SurfaceFeed::clear() {
  surface_.clear();
  wrong_.clear();
}

}  // namespace viscera::rviz_plugin
