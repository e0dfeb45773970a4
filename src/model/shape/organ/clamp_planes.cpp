// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/clamp_planes.h"

#include <cmath>

#include "model/shape/organ/tissue.h"

namespace viscera {
namespace {

constexpr double kParallel = 1e-9;  ///< sine of an angle that counts as rounding
constexpr double kWithin = 1e-6;    ///< share of the body's size: faces closer to its border are outside

/// Adds a plane, unless that axis already has one or the plane is across none.
void take(const Vector3d& point_m, const Vector3d& normal, NodePlanes& planes) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Vector3d aside = normal - normal[axis] * Vector3d::Unit(axis);
  if (aside.norm() <= kParallel * normal.norm() && !planes[axis]) planes[axis] = point_m[axis];
}

}  // namespace

NodePlanes clampPlanes(const BodyConfig& config, const Eigen::AlignedBox3d& bounds) {
  const Pose pose = bodyPose(config);
  const double slack_m = kWithin * bounds.sizes().maxCoeff();
  const Eigen::AlignedBox3d inner(bounds.min().array() + slack_m, bounds.max().array() - slack_m);
  NodePlanes planes;
  for (const FixedConfig& fixed : config.fixed) {
    if (fixed.shape == FixedShape::kPlane) take(pose * fixed.point_m, pose.orientation * fixed.normal, planes);
    if (fixed.shape != FixedShape::kBox) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d normal = pose.orientation * Vector3d::Unit(axis);
      int across = 0;
      normal.cwiseAbs().maxCoeff(&across);
      for (const Vector3d& face : {fixed.min_m, fixed.max_m}) {
        const Vector3d point_m = pose * face;
        if (point_m[across] > inner.min()[across] && point_m[across] < inner.max()[across])
          take(point_m, normal, planes);
      }
    }
  }
  return planes;
}

}  // namespace viscera
