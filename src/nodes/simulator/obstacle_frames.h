// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

#include "nodes/ros/carried_frames.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// Obstacles that tf frames carry: looks their frames up before every tick.
class ObstacleFrames {
 public:
  /// @param frames  must outlive this
  /// @param max_transform_age_s  of what tf knows of a frame that moves [s]
  ObstacleFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);

  /// Tells the session where the frames are now. An obstacle whose frame tf does not know stays where it was.
  void apply(Session& session);
  bool empty() const { return carried_.empty(); }
  /// @name Lookups since the start, for the diagnostics; from any thread
  /// @{
  uint64_t found() const { return carried_.found(); }
  uint64_t missed() const { return carried_.missed(); }
  /// Ticks since the start or the last reset in which a frame was faster than tissue can follow.
  uint64_t heldBack() const { return held_back_; }
  /// @}

 private:
  CarriedFrames carried_;
  std::atomic<uint64_t> held_back_{0};
};

}  // namespace viscera::nodes
