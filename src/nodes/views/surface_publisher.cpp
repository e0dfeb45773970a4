// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/surface_publisher.h"
#include "nodes/views/surface_messages.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace viscera::nodes {
namespace {

constexpr uint32_t kMarkerQueue = 32;             ///< two messages per body and frame: surface and cut walls
constexpr uint32_t kChangeQueue = 100;            ///< seconds of a cut; a lost change makes the following ones useless
constexpr size_t kMaxMarkerTriangles = 10000000;  ///< TCPROS refuses messages of 1 GB; a triangle takes 72 bytes

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle& node, const std::string& tissue_frame)
    : frame_(tissue_frame),
      topology_(node.advertise<SurfaceTopology>("surface_topology", 1, true)),
      change_(node.advertise<SurfaceTopologyChange>("surface_topology_change", kChangeQueue)),
      vertices_(node.advertise<SurfaceVertices>("surface", 1)),
      strain_(node.advertise<SurfaceVertices>("surface_strain", 1)),
      marker_(node.advertise<visualization_msgs::Marker>("surface_marker", kMarkerQueue)) {}

uint32_t SurfacePublisher::viewers() const {
  uint32_t viewers = 0;
  for (const ros::Publisher* topic : {&vertices_, &strain_, &marker_, &topology_, &change_})
    viewers += topic->getNumSubscribers();
  return viewers;
}

void SurfacePublisher::start(const std::shared_ptr<const VisibleTopology>& skin, const ros::Time& stamp) {
  sent_ = SentVertices(*skin);
  sent_.follow(*skin);
  revision_ = skin->revision;
  whole_ = toTopology(*skin, sent_, whole_.version + 1, frame_, stamp);
  sendTopology();
}

void SurfacePublisher::changeTopology(const VisibleTopology& topology, const ros::Time& stamp) {
  revision_ = topology.revision;
  sent_.follow(topology);
  SurfaceTopology next = toTopology(topology, sent_, whole_.version + 1, frame_, stamp);
  if (change_.getNumSubscribers() > 0) change_.publish(toChange(whole_, next));
  whole_ = std::move(next);
  is_sent_ = false;
}

void SurfacePublisher::sendTopology() {
  const double seconds = static_cast<double>(sizeof(uint32_t) * whole_.triangles.size()) / kTopologyBytesPerSecond;
  const auto now = std::chrono::steady_clock::now();
  next_whole_ =
      now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
  again_ = std::max(next_whole_, now + kAgain_s);
  is_sent_ = true;
  topology_.publish(whole_);
}

std::optional<std::chrono::steady_clock::time_point> SurfacePublisher::due() const {
  if (whole_.version == 0) return std::nullopt;
  return is_sent_ ? again_ : next_whole_;
}

void SurfacePublisher::publishDue() {
  const auto now = std::chrono::steady_clock::now();
  if (!due() || now < *due()) return;
  if (is_sent_ && topology_.getNumSubscribers() == 0)
    again_ = now + kAgain_s;  // new subscribers receive the latched message
  else
    sendTopology();
}

void SurfacePublisher::publish(const SurfaceFrame& frame, const ros::Time& stamp) {
  if (frame.topology->revision != revision_) changeTopology(*frame.topology, stamp);
  publishDue();
  if (vertices_.getNumSubscribers() > 0)
    vertices_.publish(toVertices(frame, frame.colors, sent_, whole_.version, frame_, stamp));
  if (isStrainWanted() && !frame.strain_colors.empty())
    strain_.publish(toVertices(frame, frame.strain_colors, sent_, whole_.version, frame_, stamp));
  if (marker_.getNumSubscribers() > 0) publishMarkers(frame, stamp);
}

void SurfacePublisher::publishMarkers(const SurfaceFrame& frame, const ros::Time& stamp) {
  if (frame.topology->triangleCount() > kMaxMarkerTriangles) {
    ROS_WARN_ONCE("surface_marker: a message cannot hold more than %zu triangles; use `surface`", kMaxMarkerTriangles);
    return;
  }
  const std::vector<visualization_msgs::Marker> markers = toMarkers(frame, frame_, stamp);
  const size_t bodies = markers.size() / 2;
  wounds_sent_.resize(bodies);
  for (size_t b = 0; b < bodies; ++b) {  // only if necessary: the last message of a client then has a surface
    const visualization_msgs::Marker& wounds = markers[bodies + b];
    const bool any = wounds.action != visualization_msgs::Marker::DELETE;
    if (any || wounds_sent_[b]) marker_.publish(wounds);
    wounds_sent_[b] = any;
  }
  for (size_t b = 0; b < bodies; ++b) marker_.publish(markers[b]);
}

}  // namespace viscera::nodes
