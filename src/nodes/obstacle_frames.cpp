// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/obstacle_frames.h"

#include <ros/console.h>

#include "nodes/frame_lookup.h"

namespace viscera::nodes {
namespace {

constexpr double kWarnPeriod_s = 5;

}  // namespace

ObstacleFrames::ObstacleFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s)
    : frames_(frames), tissue_frame_(scene.environment.tissue_frame), max_transform_age_s_(max_transform_age_s) {
  for (size_t i = 0; i < scene.obstacles.size(); ++i) {
    if (!scene.obstacles[i].frame.empty()) carried_.push_back({i, scene.obstacles[i].frame});
  }
}

void ObstacleFrames::apply(Session& session) {
  const uint64_t held_back = session.extremes().obstacles_held_back;
  if (held_back > held_back_) {
    ROS_WARN_THROTTLE(kWarnPeriod_s,
                      "the frame of an obstacle is faster than tissue can follow: it is held back (%lu ticks)",
                      static_cast<unsigned long>(held_back));
  }
  held_back_ = held_back;
  for (const Carried& it : carried_) {
    try {
      session.setObstacleFrame(it.obstacle, newestPose(frames_, tissue_frame_, it.frame, max_transform_age_s_));
      ++found_;
    } catch (const tf2::TransformException& error) {
      ++missed_;
      ROS_WARN_THROTTLE(kWarnPeriod_s, "obstacle %s stays where it is: frame %s is not known (%s)",
                        session.scene().obstacles[it.obstacle].name.c_str(), it.frame.c_str(), error.what());
    }
  }
}

}  // namespace viscera::nodes
