// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/mouse_aim.h"

#include <cmath>

namespace viscera::rviz_plugin {
namespace {

std::array<double, 3> array(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Returns the distance of the mean of all vertices along a ray.
double middleAlong(const ScreenRay& ray, const std::vector<float>& positions_m) {
  Vector3d sum = Vector3d::Zero();
  for (size_t i = 0; i + 2 < positions_m.size(); i += 3)
    sum += Vector3d(positions_m[i], positions_m[i + 1], positions_m[i + 2]);
  return (3 * sum / static_cast<double>(positions_m.size()) - ray.origin_m).dot(ray.direction);
}

}  // namespace

std::optional<Pose> MouseAim::at(const ScreenRay& ray, const received::SentSurface& live, double depth_m,
                                 double tilt_rad, bool pressed) {
  if (live.vertices() && live.topology() && (!vertices_ || (!pressed && depth_m < 0))) {
    topology_ = live.topology();
    vertices_ = live.vertices();
  }
  if (!vertices_ || vertices_->positions_m.empty()) return std::nullopt;
  const auto hit = received::firstHit(*topology_, vertices_->positions_m, array(ray.origin_m), array(ray.direction));
  if (hit) distance_m_ = hit->distance_m;
  if (!distance_m_) distance_m_ = middleAlong(ray, vertices_->positions_m);
  Pose pose;
  pose.position_m = ray.origin_m + (*distance_m_ + depth_m) * ray.direction;
  const Vector3d shaft = (ray.right - ray.up).normalized();  // the shaft's upper end is at the lower right
  const Vector3d z = -std::cos(tilt_rad) * ray.direction + std::sin(tilt_rad) * shaft;
  const Vector3d y = z.cross(ray.right).normalized();
  Eigen::Matrix3d axes;
  axes << y.cross(z), y, z;
  pose.orientation = Eigen::Quaterniond(axes).normalized();
  return pose;
}

}  // namespace viscera::rviz_plugin
