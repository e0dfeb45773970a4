// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/camera_frames.h"

#include <ros/console.h>

#include "nodes/frame_lookup.h"

namespace viscera::nodes {

CameraFrames::CameraFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s)
    : frames_(frames), tissue_frame_(scene.environment.tissue_frame), max_transform_age_s_(max_transform_age_s) {
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const std::string& frame = scene.cameras[i].frame;
    placed_.push_back(frame.empty());
    if (!frame.empty()) carried_.push_back({i, frame, {}});
  }
}

bool CameraFrames::apply(Session& session) {
  constexpr double kWarnPeriod_s = 5;
  bool moved = false;
  for (Carried& it : carried_) {
    try {
      const Pose pose = newestPose(frames_, tissue_frame_, it.frame, max_transform_age_s_);
      moved = moved || !placed_[it.camera] || pose.position_m != it.pose.position_m ||
              pose.orientation.coeffs() != it.pose.orientation.coeffs();
      it.pose = pose;
      placed_[it.camera] = true;
      session.setCameraFrame(it.camera, pose);
      ++found_;
    } catch (const tf2::TransformException& error) {
      ++missed_;
      ROS_WARN_THROTTLE(kWarnPeriod_s, "camera %s stays where it is: frame %s is not known (%s)",
                        session.scene().cameras[it.camera].name.c_str(), it.frame.c_str(), error.what());
    }
  }
  return moved;
}

}  // namespace viscera::nodes
