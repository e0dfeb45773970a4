// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/obstacle_frames.h"

#include <ros/console.h>

namespace viscera::nodes {

ObstacleFrames::ObstacleFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s)
    : carried_("obstacle", scene, frames, max_transform_age_s) {
  for (size_t i = 0; i < scene.obstacles.size(); ++i)
    carried_.add(i, scene.obstacles[i].name, scene.obstacles[i].frame);
}

void ObstacleFrames::apply(Session& session) {
  constexpr double kWarnPeriod_s = 5;
  const uint64_t speed_limited = session.extremes().obstacles_speed_limited;
  if (speed_limited > speed_limited_) {
    ROS_WARN_THROTTLE(kWarnPeriod_s,
                      "the frame of an obstacle moves faster than tissue can follow; its speed is limited (%lu ticks)",
                      static_cast<unsigned long>(speed_limited));
  }
  speed_limited_ = speed_limited;
  carried_.lookUp([&](size_t obstacle, const Pose& pose) { session.setObstacleFrame(obstacle, pose); });
}

}  // namespace viscera::nodes
