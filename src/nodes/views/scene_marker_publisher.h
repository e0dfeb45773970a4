// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <string>

#include "nodes/views/scene_markers.h"

namespace viscera::nodes {

/// Topic `scene_markers`, for rviz: latched, so that a viewer who comes while the scene is made, or paused, sees it.
class SceneMarkerPublisher {
 public:
  SceneMarkerPublisher(ros::NodeHandle& node, const Scene& scene, const PublishOptions& options);

  /// There are subscribers. From any thread.
  bool isWanted() const { return publisher_.getNumSubscribers() > 0; }
  /// There are subscribers, and it is time for the next, by the steady clock: it comes while paused too.
  bool isDue();
  /// How often from now on, at most. For the thread that asks isDue().
  void setRate(double rate_hz) { period_ = period(rate_hz); }
  /// From any one thread.
  void publish(const SceneLook& look, const ros::Time& stamp);
  /// A text alone, in the place of all else, where it is not the last one again.
  void tell(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  static Clock::duration period(double rate_hz);

  const SceneMarkers markers_;
  Clock::duration period_;
  Clock::time_point next_{};
  std::string told_;
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
