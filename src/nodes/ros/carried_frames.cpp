// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/carried_frames.h"

#include <ros/console.h>

#include "nodes/ros/frame_lookup.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

CarriedFrames::CarriedFrames(const char* kind, const Scene& scene, const tf2_ros::Buffer& frames,
                             double max_transform_age_s)
    : kind_(kind),
      frames_(frames),
      tissue_frame_(scene.environment.tissue_frame),
      max_transform_age_s_(max_transform_age_s) {}

void CarriedFrames::add(size_t index, const std::string& name, const std::string& frame) {
  if (!frame.empty()) carried_.push_back({index, name, frame});
}

void CarriedFrames::lookUp(const std::function<void(size_t, const Pose&)>& take) {
  for (const Carried& it : carried_) {
    try {
      take(it.index, newestPose(frames_, tissue_frame_, it.frame, max_transform_age_s_));
      ++found_;
    } catch (const tf2::TransformException& error) {
      ++missed_;
      warn(it, error.what());
    }
  }
}

/// Warns at most once per period, for all objects of a kind.
void CarriedFrames::warn(const Carried& carried, const char* why) {
  constexpr std::chrono::seconds kPeriod{5};
  const auto now = std::chrono::steady_clock::now();
  if (now < may_warn_) return;
  may_warn_ = now + kPeriod;
  ROS_WARN("%s %s keeps its pose: frame %s is unknown (%s)", kind_, carried.name.c_str(), carried.frame.c_str(), why);
}

}  // namespace viscera::nodes
