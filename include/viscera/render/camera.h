// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace VISCERA_PUBLIC viscera {

/// Pinhole intrinsics [px] of a camera: square pixels, principal point at the image centre. Pixel (column, row) covers
/// [column, column + 1) x [row, row + 1), row 0 at the top, so its centre is at (column + 0.5, row + 0.5). A point (x,
/// y, z) of the optical frame appears at (fx x / z + cx, fy y / z + cy), or through a lens with distortion at
/// pixelOf(). Where pixel centres are whole numbers (OpenCV, sensor_msgs/CameraInfo) the principal point is (cx - 0.5,
/// cy - 0.5).
struct Intrinsics {
  double fx, fy, cx, cy;
};
Intrinsics intrinsics(const CameraConfig& camera);

/// Returns where a camera's image shows a point [m] of its optical frame [px], which may be outside the image. Returns
/// nothing for a point that is not in front of the camera, or too far to the side for its lens with distortion.
std::optional<Eigen::Vector2d> pixelOf(const CameraConfig& camera, const Vector3d& optical);
/// Returns the line of sight of a place of the image [px], from the eye: in the optical frame, with z = 1.
/// @throws SceneError  naming the camera: its distortion gives the place no line of sight (a scene that was read has no
/// such camera)
Vector3d lineOfSight(const CameraConfig& camera, const Eigen::Vector2d& pixel);
/// Returns the pinhole camera of the same focal length that sees all that a camera with distortion sees. It is drawn
/// first, and the lens then distorts its image. It has the same centre and another number of pixels. For a camera
/// without distortion it is the camera itself.
/// @throws SceneError  as lineOfSight()
CameraConfig pinholeOf(const CameraConfig& camera);

/// Returns the pose of the camera's optical frame (x right, y down, z forward) in the tissue frame.
/// @throws SceneError  naming the camera, if the target is at its position or `up` is along the line of sight
Pose opticalPose(const CameraConfig& camera);

/// Returns whether cameras[].frame names an optical frame itself (REP 103: `_optical`, `_optical_frame`).
bool isCarriedByOpticalFrame(const CameraConfig& camera);
/// Returns the pose of the optical frame in the tissue frame of a camera that a tf frame carries.
/// @param frame  pose of CameraConfig::frame in the tissue frame   @throws SceneError  as above
Pose carriedOpticalPose(const CameraConfig& camera, const Pose& frame);
/// Returns the pose of the optical frame of a camera in an endoscope (CameraConfig::stylus), in the tissue frame. The
/// lens is at the tip and looks along -z of the stylus, tilted by lens_angle_deg towards its -y. CameraConfig::up is up
/// in the image, as the head of the camera does not turn with the shaft; where the camera looks along it, y of the
/// stylus is, tilted like the sight. @param tip  pose of the stylus in the tissue frame
Pose endoscopePose(const CameraConfig& camera, const Pose& tip);
/// Moves the cameras in styluses that are present. @param poses  [cameras] of optical frames
void placeEndoscopes(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
                     const ToolMotions& motions, std::vector<Pose>& poses);
/// Returns the motions of the tools that a camera shows: an endoscope does not show itself.
ToolMotions shownTools(const CameraConfig& camera, const std::vector<StylusConfig>& styluses,
                       const ToolMotions& motions);
/// Returns the pose of a stereo camera's right eye in the camera's optical frame, which is that of the left eye.
Pose rightEye(const CameraConfig& camera);

/// Depths [m] along the optical axis between which things are drawn.
struct DepthRange {
  double near_m, far_m;
};
/// Returns a hundredth to a hundred times the distance of the target. A tool in front of the lens and a whole room are
/// both in view, and 24 bits of depth still separate surfaces 1e-5 of the distance apart at the target.
DepthRange depthRange(const CameraConfig& camera);

/// Returns the transform from optical-frame points to OpenGL clip coordinates. The y axis points down in both: images
/// are drawn with their first row at OpenGL's bottom row, so that rows read back come top first.
Eigen::Matrix4f clipFromOptical(const CameraConfig& camera);

/// Returns the homogeneous matrix of a pose.
Eigen::Matrix4f poseMatrix(const Pose& pose);

}  // namespace viscera
