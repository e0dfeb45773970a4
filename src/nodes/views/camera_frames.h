// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "nodes/ros/carried_frames.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// Cameras that tf frames carry. Their frames are looked up before every tick, and while paused.
class CameraFrames {
 public:
  /// @param frames  must outlive this object
  /// @param max_transform_age_s  largest age of a moving frame's transform [s]
  CameraFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);

  /// Sets the cameras' poses in the session. A camera stays where it is if tf does not know its frame.
  /// @returns whether one has moved
  bool apply(Session& session);
  /// Returns whether the camera's pose was ever known; until then it makes no images. Called on the simulation thread.
  bool isPlaced(size_t camera) const { return placed_[camera]; }
  bool empty() const { return carried_.empty(); }
  /// @name Number of lookups since the start, for the diagnostics; thread-safe
  /// @{
  uint64_t found() const { return carried_.found(); }
  uint64_t missed() const { return carried_.missed(); }
  /// @}

 private:
  CarriedFrames carried_;
  std::vector<bool> placed_;  ///< [cameras]
  std::vector<Pose> poses_;   ///< [cameras] last poses
};

}  // namespace viscera::nodes
