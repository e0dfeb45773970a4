// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "nodes/views/markers/scene_markers.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Leaves out meshes that viewers already have: a viewer keeps a marker until it receives another one of the same name
/// and id.
class SentMeshes {
 public:
  /// Returns the markers that are not meshes, have changed, or were not sent for kEvery_s.
  visualization_msgs::MarkerArray newsOf(const visualization_msgs::MarkerArray& whole, SteadyTime now);
  /// Forgets what viewers have.
  void clear() { sent_.clear(); }

  static constexpr double kEvery_s = 5;  ///< every part of a bag that is split then has all of them

 private:
  std::map<std::pair<std::string, int32_t>, visualization_msgs::Marker> sent_;
  SteadyTime all_sent_{};
};

/// Publishes topic `scene_markers` for rviz. A new viewer receives everything at once, also while the scene is created
/// or paused. Later, meshes are sent only when they change, and every 5 s.
class SceneMarkerPublisher {
 public:
  SceneMarkerPublisher(ros::NodeHandle& node, const Scene& scene, const PublishOptions& options);

  /// Returns whether there are subscribers. Thread-safe.
  bool isWanted() const { return publisher_.getNumSubscribers() > 0; }
  uint32_t viewers() const { return publisher_.getNumSubscribers(); }  ///< number of subscribers; thread-safe
  /// Returns whether there are subscribers and the next message is due by the steady clock, also while paused.
  bool isDue();
  /// Sets the largest rate. Called on the thread that calls isDue().
  void setRate(double rate_hz) { period_ = period(rate_hz); }
  /// Publishes the markers. Any one thread may call it.
  void publish(const SceneStyle& style, const ros::Time& stamp);
  /// Publishes a text in place of everything else, unless it is the same as before.
  void tell(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  static Clock::duration period(double rate_hz);
  void welcome(const ros::SingleSubscriberPublisher& viewer);
  void keep(const visualization_msgs::MarkerArray& whole);

  const SceneMarkers markers_;
  Clock::duration period_;
  Clock::time_point next_{};
  std::string last_;
  SentMeshes sent_;
  std::mutex mutex_;
  visualization_msgs::MarkerArray whole_;  ///< markers that viewers have
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
