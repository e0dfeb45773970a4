// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "nodes/views/scene_markers.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Leaves out meshes that viewers have: a viewer keeps a marker until it is told another one of that name and number.
class SentMeshes {
 public:
  /// What of an array is not a mesh, is another one than before, or was not sent for `every_s`.
  visualization_msgs::MarkerArray newsOf(const visualization_msgs::MarkerArray& whole, SteadyTime now);
  /// Viewers have nothing.
  void clear() { sent_.clear(); }

  static constexpr double kEvery_s = 5;  ///< so that each part of a bag that is split has them all

 private:
  std::map<std::pair<std::string, int32_t>, visualization_msgs::Marker> sent_;
  SteadyTime all_sent_{};
};

/// Topic `scene_markers`, for rviz. A viewer who comes has all at once, also while the scene is made, or paused; from
/// then on meshes only as they change, and every 5 s.
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
  void welcome(const ros::SingleSubscriberPublisher& viewer);
  void keep(const visualization_msgs::MarkerArray& whole);

  const SceneMarkers markers_;
  Clock::duration period_;
  Clock::time_point next_{};
  std::string told_;
  SentMeshes sent_;
  std::mutex mutex_;
  visualization_msgs::MarkerArray whole_;  ///< what viewers have by now
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
