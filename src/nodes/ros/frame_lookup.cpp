// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/frame_lookup.h"

#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

bool isPose(const Pose& pose) {
  constexpr double kLeast = 1e-6;  // least norm of a quaternion that has an orientation
  return pose.position_m.allFinite() && pose.orientation.coeffs().allFinite() && pose.orientation.norm() > kLeast;
}

}  // namespace

Pose newestPose(const tf2_ros::Buffer& frames, const std::string& tissue_frame, const std::string& frame,
                double max_age_s) {
  const geometry_msgs::TransformStamped newest = frames.lookupTransform(tissue_frame, frame, ros::Time(0));
  if (isOlder(newest, max_age_s)) throw tf2::TransformException("its newest transform is too old");
  Pose pose = fromMessage(newest.transform);
  if (!isPose(pose)) throw tf2::TransformException("its transform is not finite");
  pose.orientation.normalize();
  return pose;
}

}  // namespace viscera::nodes
