// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/surface_feed.h"

#include <ros/transport_hints.h>

#include <algorithm>
#include <utility>

namespace viscera::received {
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
      topic_ + "_topology", 1,
      [this](const SurfaceTopologyConstPtr& message) {
        last_.whole = message->header.stamp;
        if (last_.whole != dead_.whole) take(*message);
      },
      {}, hints);
  changes_ = node_.subscribe<SurfaceTopologyChange>(
      topic_ + "_topology_change", kChangesQueue,
      [this](const SurfaceTopologyChangeConstPtr& message) { take(*message); }, {}, hints);
  vertices_ = node_.subscribe<SurfaceVertices>(
      topic_ + (strain_ ? "_strain" : ""), 1,
      [this](const SurfaceVerticesConstPtr& message) {
        last_.vertices = message->header.stamp;
        if (last_.vertices != dead_.vertices) take(message);
      },
      {}, hints);
}

void SurfaceFeed::unsubscribe() {
  whole_.shutdown();
  changes_.shutdown();
  vertices_.shutdown();
  whole_ = changes_ = vertices_ = ros::Subscriber();
  watch_.follow("");
  senders_.clear();
  gone_.reset();
  dead_ = {};
}

bool SurfaceFeed::renew() {
  SenderWatch::Senders now = watch_.senders();
  if (!now.known) return false;
  if (std::includes(now.alive.begin(), now.alive.end(), senders_.begin(), senders_.end())) {
    gone_.reset();
    senders_ = std::move(now.alive);
    return false;
  }
  if (!gone_) gone_ = last_;
  if (now.alive.empty()) return false;
  const bool others = std::any_of(senders_.begin(), senders_.end(),
                                  [&now](const std::string& uri) { return now.alive.count(uri) > 0; });
  dead_ = others ? Stamps{} : *gone_;  // with several nodes it is not known which sent the last
  gone_.reset();
  senders_ = std::move(now.alive);
  clear();
  connect();
  return true;
}

void SurfaceFeed::clear() {
  surface_.clear();
  wrong_.clear();
}

}  // namespace viscera::received
