// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "viscera/math/types.h"
#include "viscera/model/scene/camera_config.h"

namespace viscera {

/// Pinhole intrinsics [px] of a camera: square pixels, principal point at the image centre. Pixel (column, row) covers
/// [column, column + 1) x [row, row + 1), row 0 at the top, so its centre is at (column + 0.5, row + 0.5).
/// A point (x, y, z) of the optical frame is seen at (fx x / z + cx, fy y / z + cy), through a lens with distortion
/// where its distorted place is: see pixelOf(). Where pixel centres are whole numbers (OpenCV, sensor_msgs/CameraInfo)
/// the principal point is (cx - 0.5, cy - 0.5).
struct Intrinsics {
  double fx, fy, cx, cy;
};
Intrinsics intrinsics(const CameraConfig& camera);

/// Where a camera's image shows a point [m] of its optical frame [px], which may be beside the image. None for one that
/// is not in front, or so far aside that a lens with distortion shows it nowhere.
std::optional<Eigen::Vector2d> pixelOf(const CameraConfig& camera, const Vector3d& optical);
/// The line of sight of a place of the image [px], from the eye: in the optical frame, with z = 1.
/// @throws SceneError  naming the camera: its distortion leaves the place none (a scene that was read has no such
/// camera)
Vector3d lineOfSight(const CameraConfig& camera, const Eigen::Vector2d& pixel);
/// The pinhole of the same focal length that sees all that a camera with distortion sees: what is drawn, before its
/// lens bends it. The same middle, other numbers of pixels. A camera without distortion is its own.
/// @throws SceneError  as lineOfSight()
CameraConfig pinholeOf(const CameraConfig& camera);

/// Pose of the camera's optical frame (x right, y down, z forward) in the tissue frame.
/// @throws SceneError  naming the camera, if the target is at its position or `up` is along the line of sight
Pose opticalPose(const CameraConfig& camera);

/// Does cameras[].frame name an optical frame itself (REP 103: `_optical`, `_optical_frame`)?
bool isCarriedByOpticalFrame(const CameraConfig& camera);
/// Pose of the optical frame in the tissue frame of a camera that a tf frame carries.
/// @param frame  pose of CameraConfig::frame in the tissue frame   @throws SceneError  as above
Pose carriedOpticalPose(const CameraConfig& camera, const Pose& frame);
/// Of a stereo camera: the right eye in the optical frame of the camera, which is the left one.
Pose rightEye(const CameraConfig& camera);

/// Depths [m] along the optical axis between which something is drawn.
struct DepthRange {
  double near_m, far_m;
};
/// A hundredth to a hundred times the distance of the target: a tool before the lens and a whole room are both in
/// view, and 24 bits of depth still part surfaces 1e-5 of the distance from each other at the target.
DepthRange depthRange(const CameraConfig& camera);

/// OpenGL clip coordinates of optical-frame points. The optical frame's y points down and stays so: images are drawn
/// with their first row at OpenGL's bottom row, so that rows read back come top first and never need turning.
Eigen::Matrix4f clipFromOptical(const CameraConfig& camera);

/// Homogeneous matrix of a pose.
Eigen::Matrix4f poseMatrix(const Pose& pose);

}  // namespace viscera
