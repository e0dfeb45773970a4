// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

#include "nodes/ros/carried_frames.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// Obstacles that tf frames carry. Their frames are looked up before every tick.
class ObstacleFrames {
 public:
  /// @param frames  must outlive this object
  /// @param max_transform_age_s  largest age of a moving frame's transform [s]
  ObstacleFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);

  /// Sets the obstacles' poses in the session. An obstacle stays where it is if tf does not know its frame.
  void apply(Session& session);
  bool empty() const { return carried_.empty(); }
  /// @name Number of lookups since the start, for the diagnostics; thread-safe
  /// @{
  uint64_t found() const { return carried_.found(); }
  uint64_t missed() const { return carried_.missed(); }
  /// Returns the number of ticks since the start or the last reset in which an obstacle was limited to the speed that
  /// tissue can follow.
  uint64_t speedLimited() const { return speed_limited_; }
  /// @}

 private:
  CarriedFrames carried_;
  std::atomic<uint64_t> speed_limited_{0};
};

}  // namespace viscera::nodes
