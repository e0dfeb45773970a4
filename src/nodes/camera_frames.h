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

/// Cameras that tf frames carry: looks their frames up before every tick, and in pauses.
class CameraFrames {
 public:
  /// @param frames  must outlive this
  /// @param max_transform_age_s  of what tf knows of a frame that moves [s]
  CameraFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);

  /// Tells the session where the frames are now. A camera whose frame tf does not know stays where it was.
  /// @returns whether one has moved
  bool apply(Session& session);
  /// Has the camera's place ever been known? Until then it has no pictures. For the simulation's thread.
  bool isPlaced(size_t camera) const { return placed_[camera]; }
  bool empty() const { return carried_.empty(); }
  /// @name Lookups since the start, for the diagnostics; from any thread
  /// @{
  uint64_t found() const { return found_; }
  uint64_t missed() const { return missed_; }
  /// @}

 private:
  struct Carried {
    size_t camera;
    std::string frame;
    Pose pose;  ///< the last one
  };
  const tf2_ros::Buffer& frames_;
  const std::string tissue_frame_;
  const double max_transform_age_s_;
  std::vector<Carried> carried_;
  std::vector<bool> placed_;  ///< [cameras]
  std::atomic<uint64_t> found_{0}, missed_{0};
};

}  // namespace viscera::nodes
