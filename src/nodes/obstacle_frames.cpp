// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/obstacle_frames.h"

#include <ros/console.h>

#include "nodes/conversions.h"

namespace viscera::nodes {
namespace {

constexpr double kWarnPeriod_s = 5;

bool isPose(const Pose& pose) {
  constexpr double kLeast = 1e-6;  // of a quaternion's length: below it there is no orientation
  return pose.position_m.allFinite() && pose.orientation.coeffs().allFinite() && pose.orientation.norm() > kLeast;
}

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
      const geometry_msgs::TransformStamped newest = frames_.lookupTransform(tissue_frame_, it.frame, ros::Time(0));
      if (isOlder(newest, max_transform_age_s_)) throw tf2::TransformException("its newest transform is too old");
      Pose pose = fromMessage(newest.transform);
      if (!isPose(pose)) throw tf2::TransformException("its transform is not finite");
      pose.orientation.normalize();
      session.setObstacleFrame(it.obstacle, pose);
      ++found_;
    } catch (const tf2::TransformException& error) {
      ++missed_;
      ROS_WARN_THROTTLE(kWarnPeriod_s, "obstacle %s stays where it is: frame %s is not known (%s)",
                        session.scene().obstacles[it.obstacle].name.c_str(), it.frame.c_str(), error.what());
    }
  }
}

}  // namespace viscera::nodes
