// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/camera_frames.h"

namespace viscera::nodes {

CameraFrames::CameraFrames(const Scene& scene, const tf2_ros::Buffer& frames, double max_transform_age_s)
    : carried_("camera", scene, frames, max_transform_age_s), poses_(scene.cameras.size()) {
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const CameraConfig& camera = scene.cameras[i];
    placed_.push_back(camera.frame.empty());
    carried_.add(i, camera.name, camera.frame);
  }
}

bool CameraFrames::apply(Session& session) {
  bool moved = false;
  carried_.lookUp([&](size_t camera, const Pose& pose) {
    Pose& last = poses_[camera];
    moved = moved || !placed_[camera] || pose.position_m != last.position_m ||
            pose.orientation.coeffs() != last.orientation.coeffs();
    last = pose;
    placed_[camera] = true;
    session.setCameraFrame(camera, pose);
  });
  return moved;
}

}  // namespace viscera::nodes
