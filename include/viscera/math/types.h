// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

using SteadyTime = std::chrono::steady_clock::time_point;

/// Rigid pose: position [m] and orientation (unit quaternion) of a frame in its parent frame.
struct Pose {
  Vector3d position_m = Vector3d::Zero();
  Quaterniond orientation = Quaterniond::Identity();

  /// Returns a point [m] of this frame in the parent frame.
  Vector3d operator*(const Vector3d& local_m) const { return position_m + orientation * local_m; }
  /// Returns the pose of `child`'s frame in the parent frame.
  Pose operator*(const Pose& child) const { return {*this * child.position_m, orientation * child.orientation}; }
  /// Returns the pose of the parent frame in this frame.
  Pose inverse() const {
    const Quaterniond back = orientation.conjugate();
    return {-(back * position_m), back};
  }
};

/// Returns the orientation after turns [deg] about the fixed x, then y, then z axis.
inline Quaterniond rotationFromDegrees(const Vector3d& turns_deg) {
  const Vector3d a = turns_deg * (3.14159265358979323846 / 180.0);
  return Eigen::AngleAxisd(a.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(a.x(), Vector3d::UnitX());
}

/// Returns the turns [deg] that rotationFromDegrees() makes into this orientation; y is within -90..90.
inline Vector3d degreesFromRotation(const Quaterniond& orientation) {
  const Eigen::Matrix3d r = orientation.toRotationMatrix();
  const double y = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  const bool locked = std::abs(r(2, 0)) > 1 - 1e-12;  // x and z turn about the same axis: x takes all of it
  const double x = locked ? std::atan2(-r(1, 2), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
  const double z = locked ? 0.0 : std::atan2(r(1, 0), r(0, 0));
  return Vector3d(x, y, z) * (180.0 / 3.14159265358979323846);
}

/// Returns the pose at fraction s in [0, 1] from `a` to `b`: linear in position, spherical-linear in orientation.
inline Pose interpolate(const Pose& a, const Pose& b, double s) {
  return {a.position_m + s * (b.position_m - a.position_m), a.orientation.slerp(s, b.orientation)};
}

}  // namespace viscera
