// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

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
  uint64_t found() const { return found_; }
  uint64_t missed() const { return missed_; }
  /// Ticks since the start or the last reset in which a frame was faster than tissue can follow.
  uint64_t heldBack() const { return held_back_; }
  /// @}

 private:
  struct Carried {
    size_t obstacle;
    std::string frame;
  };
  const tf2_ros::Buffer& frames_;
  const std::string tissue_frame_;
  const double max_transform_age_s_;
  std::vector<Carried> carried_;
  std::atomic<uint64_t> found_{0}, missed_{0}, held_back_{0};
};

}  // namespace viscera::nodes
