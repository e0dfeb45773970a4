// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/frustum.h"

namespace viscera {

namespace {
constexpr double kMargin = 1e-4;  // of the distance to the target: float32 rounds far less
}

Frustum::Frustum(const CameraConfig& camera, const Pose& tissue_from_optical) {
  const DepthRange range = depthRange(camera);
  const Intrinsics k = intrinsics(pinholeOf(camera));
  const double right = k.cx / k.fx, down = k.cy / k.fy;  // tangents of half the angles of view
  const double margin_m = kMargin * (camera.target_m - camera.position_m).norm();
  const auto plane = [&](const Vector3d& inwards_optical, double at_m) {
    const Vector3d inwards = tissue_from_optical.orientation * inwards_optical.normalized();
    return Plane{inwards.cast<float>(),
                 static_cast<float>(at_m + inwards.dot(tissue_from_optical.position_m) - margin_m)};
  };
  planes_ = {plane({1, 0, right}, 0), plane({-1, 0, right}, 0),       plane({0, 1, down}, 0),
             plane({0, -1, down}, 0), plane({0, 0, 1}, range.near_m), plane({0, 0, -1}, -range.far_m)};
}

bool Frustum::misses(const Eigen::AlignedBox3f& box) const {
  if (box.isEmpty()) return true;
  for (const Plane& plane : planes_) {
    const Vector3f farthest = (plane.inwards.array() > 0).select(box.max(), box.min());
    if (plane.inwards.dot(farthest) < plane.at_m) return true;
  }
  return false;
}

}  // namespace viscera
