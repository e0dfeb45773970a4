// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/scene_marker_publisher.h"

#include <ros/single_subscriber_publisher.h>

#include <algorithm>

#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

/// Returns whether two markers are equal except for the stamp.
bool looksTheSame(const Marker& a, const Marker& b) {
  return a.action == b.action && a.header.frame_id == b.header.frame_id && a.frame_locked == b.frame_locked &&
         a.pose == b.pose && a.color == b.color && a.points == b.points;
}

}  // namespace

MarkerArray SentMeshes::newsOf(const MarkerArray& whole, SteadyTime now) {
  const bool all = std::chrono::duration<double>(now - all_sent_).count() >= kEvery_s;
  if (all) all_sent_ = now;
  MarkerArray out;
  for (const Marker& marker : whole.markers) {
    if (marker.type == Marker::TRIANGLE_LIST) {
      const auto [sent, first] = sent_.try_emplace({marker.ns, marker.id}, marker);
      if (!first && !all && looksTheSame(sent->second, marker)) continue;
      sent->second = marker;
    }
    out.markers.push_back(marker);
  }
  return out;
}

SceneMarkerPublisher::SceneMarkerPublisher(ros::NodeHandle& node, const Scene& scene, const PublishOptions& options)
    : markers_(scene, options),
      period_(period(options.surface_rate_hz)),
      publisher_(node.advertise<MarkerArray>(
          "scene_markers", 1, [this](const ros::SingleSubscriberPublisher& viewer) { welcome(viewer); })) {}

SceneMarkerPublisher::Clock::duration SceneMarkerPublisher::period(double rate_hz) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
}

bool SceneMarkerPublisher::isDue() {
  const Clock::time_point now = Clock::now();
  if (now < next_ || !isWanted()) return false;
  next_ = std::max(next_ + period_, now);
  return true;
}

void SceneMarkerPublisher::welcome(const ros::SingleSubscriberPublisher& viewer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!whole_.markers.empty()) viewer.publish(whole_);
}

void SceneMarkerPublisher::keep(const MarkerArray& whole) {
  const std::lock_guard<std::mutex> lock(mutex_);
  whole_ = whole;
}

void SceneMarkerPublisher::publish(const SceneStyle& style, const ros::Time& stamp) {
  const MarkerArray whole = markers_.at(style, stamp);
  keep(whole);
  publisher_.publish(sent_.newsOf(whole, Clock::now()));
}

void SceneMarkerPublisher::tell(const std::string& text) {
  if (text == last_) return;
  last_ = text;
  const MarkerArray whole = markers_.telling(text, ros::Time::now());
  keep(whole);
  sent_.clear();
  publisher_.publish(whole);
}

}  // namespace viscera::nodes
