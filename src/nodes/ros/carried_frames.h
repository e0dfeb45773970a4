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

/// Frames in tf that carry things of a scene: where they are now, counts of lookups, and a warning now and then of
/// those that tf does not know.
class CarriedFrames {
 public:
  /// @param kind  of things, for the warning: "camera"   @param frames  must outlive this
  /// @param max_transform_age_s  of what tf knows of a frame that moves [s]
  CarriedFrames(const char* kind, const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s);
  /// @param index  of the thing among its kind   @param frame  empty: nothing carries it
  void add(size_t index, const std::string& name, const std::string& frame);
  /// Looks all up. @param take  gets the index of each thing whose frame is known, and where that is
  void lookUp(const std::function<void(size_t index, const Pose& pose)>& take);

  bool empty() const { return carried_.empty(); }
  /// @name Lookups since the start; from any thread
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
