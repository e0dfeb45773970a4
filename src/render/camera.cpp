// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/render/camera.h"

#include <cmath>

#include "viscera/math/error.h"

namespace viscera {

namespace {
constexpr double kNearOverDistance = 0.01;
constexpr double kFarOverDistance = 100;
constexpr double kSmallestSine = 1e-6;  // between `up` and the line of sight; below it no direction is upright
constexpr double kSamePosition = 1e-9;  // tangent: where an image folds over, it shows other points as well
constexpr int kBeside_px = 1;           // margin, so that interpolation at a border uses pixels of the image only

/// Returns the orientation of an optical frame. @returns nothing  `up` is along the line of sight
std::optional<Quaterniond> upright(const Vector3d& forward, const Vector3d& up) {
  const Vector3d right = forward.cross(up.normalized());
  if (!(right.norm() > kSmallestSine)) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(0) = right.normalized();
  axes.col(1) = forward.cross(axes.col(0));
  axes.col(2) = forward;
  return Quaterniond(axes);
}

bool isCarriedBy(const CameraConfig& camera, const StylusConfig& stylus) {
  return !camera.stylus.empty() && camera.stylus == stylus.name;
}

}  // namespace

Intrinsics intrinsics(const CameraConfig& camera) {
  const double half_fov_rad = camera.vertical_fov_deg * M_PI / 360;
  const double focal_px = 0.5 * camera.height_px / std::tan(half_fov_rad);
  return {focal_px, focal_px, 0.5 * camera.width_px, 0.5 * camera.height_px};
}

std::optional<Eigen::Vector2d> pixelOf(const CameraConfig& camera, const Vector3d& optical) {
  if (!(optical.z() > 0)) return std::nullopt;
  const Intrinsics k = intrinsics(camera);
  Eigen::Vector2d position = optical.hnormalized();
  if (camera.distortion.any()) {
    const Eigen::Vector2d shown = distorted(camera.distortion, position);
    const auto seen = undistorted(camera.distortion, shown);
    if (!seen || !((*seen - position).norm() < kSamePosition)) return std::nullopt;
    position = shown;
  }
  return Eigen::Vector2d(k.fx * position.x() + k.cx, k.fy * position.y() + k.cy);
}

Vector3d lineOfSight(const CameraConfig& camera, const Eigen::Vector2d& pixel) {
  const Intrinsics k = intrinsics(camera);
  const Eigen::Vector2d position((pixel.x() - k.cx) / k.fx, (pixel.y() - k.cy) / k.fy);
  if (!camera.distortion.any()) return position.homogeneous();
  const auto seen = undistorted(camera.distortion, position);
  if (!seen) throw SceneError("camera '" + camera.name + "': distortion leaves a pixel without a line of sight");
  return seen->homogeneous();
}

CameraConfig pinholeOf(const CameraConfig& camera) {
  CameraConfig out = camera;
  if (!camera.distortion.any()) return out;
  // What the lens shows at the image's border surrounds all that it shows within.
  Eigen::Vector2d farthest = Eigen::Vector2d::Zero();
  const auto reach = [&](int column, int row) {
    farthest = farthest.cwiseMax(lineOfSight(camera, Eigen::Vector2d(column, row)).head<2>().cwiseAbs());
  };
  for (int column = 0; column <= camera.width_px; ++column) {
    reach(column, 0);
    reach(column, camera.height_px);
  }
  for (int row = 0; row <= camera.height_px; ++row) {
    reach(0, row);
    reach(camera.width_px, row);
  }
  const double focal_px = intrinsics(camera).fy;
  const auto pixels = [&](double tangent) {
    return 2 * (static_cast<int>(std::ceil(tangent * focal_px)) + kBeside_px);
  };
  out.width_px = pixels(farthest.x());
  out.height_px = pixels(farthest.y());
  out.vertical_fov_deg = 360 / M_PI * std::atan(0.5 * out.height_px / focal_px);
  out.distortion = {};
  return out;
}

Pose opticalPose(const CameraConfig& camera) {
  const Vector3d sight = camera.target_m - camera.position_m;
  if (!(sight.norm() > 0)) {
    throw SceneError("camera '" + camera.name + "': target_m must differ from position_m");
  }
  const std::optional<Quaterniond> orientation = upright(sight.normalized(), camera.up);
  if (!orientation) {
    throw SceneError("camera '" + camera.name +
                     "': up must be non-zero and not parallel to the line from position_m to "
                     "target_m");
  }
  return {camera.position_m, *orientation};
}

bool isCarriedByOpticalFrame(const CameraConfig& camera) {
  const auto ends = [&](const std::string& with) {
    const std::string& frame = camera.frame;
    return frame.size() >= with.size() && frame.compare(frame.size() - with.size(), with.size(), with) == 0;
  };
  return ends("_optical") || ends("_optical_frame");
}

Pose carriedOpticalPose(const CameraConfig& camera, const Pose& frame) {
  return isCarriedByOpticalFrame(camera) ? frame : frame * opticalPose(camera);
}

Pose endoscopePose(const CameraConfig& camera, const Pose& tip) {
  const double angle_rad = camera.lens_angle_deg * M_PI / 180;
  const Vector3d forward = tip.orientation * Vector3d(0, -std::sin(angle_rad), -std::cos(angle_rad));
  const std::optional<Quaterniond> orientation = upright(forward, camera.up);
  if (orientation) return {tip.position_m, *orientation};
  const Vector3d upwards = tip.orientation * Vector3d(0, std::cos(angle_rad), -std::sin(angle_rad));
  return {tip.position_m, *upright(forward, upwards)};
}

void placeEndoscopes(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
                     const ToolMotions& motions, std::vector<Pose>& poses) {
  for (size_t c = 0; c < cameras.size(); ++c) {
    for (size_t s = 0; s < styluses.size(); ++s) {
      if (motions[s].present && isCarriedBy(cameras[c], styluses[s]))
        poses[c] = endoscopePose(cameras[c], motions[s].to);
    }
  }
}

ToolMotions shownTools(const CameraConfig& camera, const std::vector<StylusConfig>& styluses,
                       const ToolMotions& motions) {
  ToolMotions out = motions;
  for (size_t s = 0; s < styluses.size(); ++s) {
    if (isCarriedBy(camera, styluses[s])) out[s].present = false;
  }
  return out;
}

Pose rightEye(const CameraConfig& camera) {
  return {Vector3d(camera.stereo_baseline_m, 0, 0), Quaterniond::Identity()};
}

DepthRange depthRange(const CameraConfig& camera) {
  const double distance_m = (camera.target_m - camera.position_m).norm();
  return {kNearOverDistance * distance_m, kFarOverDistance * distance_m};
}

Eigen::Matrix4f clipFromOptical(const CameraConfig& camera) {
  const Intrinsics k = intrinsics(camera);
  const DepthRange range = depthRange(camera);
  const double depth = range.far_m - range.near_m;
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2 * k.fx / camera.width_px;
  clip(0, 2) = 2 * k.cx / camera.width_px - 1;
  clip(1, 1) = 2 * k.fy / camera.height_px;
  clip(1, 2) = 2 * k.cy / camera.height_px - 1;
  clip(2, 2) = (range.far_m + range.near_m) / depth;
  clip(2, 3) = -2 * range.far_m * range.near_m / depth;
  clip(3, 2) = 1;
  return clip.cast<float>();
}

Eigen::Matrix4f poseMatrix(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.orientation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.position_m;
  return matrix.cast<float>();
}

}  // namespace viscera
