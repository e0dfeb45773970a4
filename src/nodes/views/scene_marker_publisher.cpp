// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/scene_marker_publisher.h"

#include <algorithm>

namespace viscera::nodes {

SceneMarkerPublisher::SceneMarkerPublisher(ros::NodeHandle& node, const Scene& scene, const PublishOptions& options)
    : markers_(scene, options),
      period_(period(options.surface_rate_hz)),
      publisher_(node.advertise<visualization_msgs::MarkerArray>("scene_markers", 1, true)) {}

SceneMarkerPublisher::Clock::duration SceneMarkerPublisher::period(double rate_hz) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
}

bool SceneMarkerPublisher::isDue() {
  const Clock::time_point now = Clock::now();
  if (now < next_ || !isWanted()) return false;
  next_ = std::max(next_ + period_, now);
  return true;
}

void SceneMarkerPublisher::publish(const SceneLook& look, const ros::Time& stamp) {
  publisher_.publish(markers_.at(look, stamp));
}

void SceneMarkerPublisher::tell(const std::string& text) {
  if (text == told_) return;
  told_ = text;
  publisher_.publish(markers_.telling(text, ros::Time::now()));
}

}  // namespace viscera::nodes
