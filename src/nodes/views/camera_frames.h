// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "nodes/ros/carried_frames.h"
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
  uint64_t found() const { return carried_.found(); }
  uint64_t missed() const { return carried_.missed(); }
  /// @}

 private:
  CarriedFrames carried_;
  std::vector<bool> placed_;  ///< [cameras]
  std::vector<Pose> poses_;   ///< [cameras] the last ones
};

}  // namespace viscera::nodes
