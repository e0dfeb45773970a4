// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/surface_publisher.h"

#include <ros/console.h>

namespace viscera::nodes {
namespace {

constexpr uint32_t kMarkerQueue = 32;             ///< two messages per body and frame: skin and wounds
constexpr size_t kMaxMarkerTriangles = 10000000;  ///< TCPROS refuses messages of 1 GB; a triangle takes 72 bytes

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame)
    : frame_(tissue_frame),
      topology_(node.advertise<SurfaceTopology>("surface_topology", 1, true)),
      vertices_(node.advertise<SurfaceVertices>("surface", 1)),
      marker_(node.advertise<visualization_msgs::Marker>("surface_marker", kMarkerQueue)) {}

uint32_t SurfacePublisher::viewers() const {
  return vertices_.getNumSubscribers() + marker_.getNumSubscribers() + topology_.getNumSubscribers();
}

void SurfacePublisher::start(const std::shared_ptr<const ShownTopology>& skin, const ros::Time& stamp) {
  sent_ = SentVertices(*skin);
  publishTopology(*skin, stamp);
}

void SurfacePublisher::publishTopology(const ShownTopology& topology, const ros::Time& stamp) {
  revision_ = topology.revision;
  sent_.follow(topology);
  topology_.publish(toTopology(topology, sent_, ++version_, frame_, stamp));
}

void SurfacePublisher::publish(const SurfaceFrame& frame, const ros::Time& stamp) {
  if (frame.topology->revision != revision_) publishTopology(*frame.topology, stamp);
  if (vertices_.getNumSubscribers() > 0) vertices_.publish(toVertices(frame, sent_, version_, frame_, stamp));
  if (marker_.getNumSubscribers() > 0) publishMarkers(frame, stamp);
}

void SurfacePublisher::publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp) {
  if (frame.topology->triangleCount() > kMaxMarkerTriangles) {
    ROS_WARN_ONCE("surface_marker: more than %zu triangles do not fit in a message; use `surface`",
                  kMaxMarkerTriangles);
    return;
  }
  const std::vector<visualization_msgs::Marker> markers = toMarkers(frame, frame_, stamp);
  const size_t bodies = markers.size() / 2;
  wounds_sent_.resize(bodies);
  for (size_t b = 0; b < bodies; ++b) {  // of wounds only what has to be: whoever keeps the last message has a skin
    const visualization_msgs::Marker& wounds = markers[bodies + b];
    const bool any = wounds.action != visualization_msgs::Marker::DELETE;
    if (any || wounds_sent_[b]) marker_.publish(wounds);
    wounds_sent_[b] = any;
  }
  for (size_t b = 0; b < bodies; ++b) marker_.publish(markers[b]);
}

}  // namespace viscera::nodes
