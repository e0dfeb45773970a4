// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// tf frames that carry objects of a scene. Looks up their poses, counts lookups, and warns at intervals of frames that
/// tf does not know.
class CarriedFrames {
 public:
  /// @param kind  kind of object, for the warning: "camera"   @param frames  must outlive this object
  /// @param max_transform_age_s  largest age of a moving frame's transform [s]
  CarriedFrames(const char* kind, const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);
  /// Adds an object. @param index  index among its kind   @param frame  frame that carries it; empty: none
  void add(size_t index, const std::string& name, const std::string& frame);
  /// Looks up all frames. @param take  called with the index and pose of each object with a known frame
  void lookUp(const std::function<void(size_t index, const Pose& pose)>& take);

  bool empty() const { return carried_.empty(); }
  /// @name Number of lookups since the start; thread-safe
  /// @{
  uint64_t found() const { return found_; }
  uint64_t missed() const { return missed_; }
  /// @}

 private:
  struct Carried {
    size_t index;
    std::string name, frame;
  };
  void warn(const Carried& carried, const char* why);

  const char* kind_;
  const tf2_ros::Buffer& frames_;
  const std::string tissue_frame_;
  const double max_transform_age_s_;
  std::vector<Carried> carried_;
  std::atomic<uint64_t> found_{0}, missed_{0};
  std::chrono::steady_clock::time_point may_warn_{};
};

}  // namespace viscera::nodes
