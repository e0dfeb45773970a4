// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/surface_detail.h"

#include <Eigen/Geometry>

namespace viscera {

TextureChart textureChart(const std::array<Eigen::Vector3d, 3>& corners_m, const std::array<Eigen::Vector2d, 3>& uv,
                          uint32_t material) {
  const Eigen::Vector3d edge1 = corners_m[1] - corners_m[0], edge2 = corners_m[2] - corners_m[0];
  const Eigen::Vector3d normal = edge1.cross(edge2);
  const double area2 = normal.squaredNorm();
  // Gradients of the two barycentric coordinates in the triangle's plane.
  const Eigen::Vector3d toward1 = area2 > 0 ? Eigen::Vector3d(edge2.cross(normal) / area2) : Eigen::Vector3d::Zero();
  const Eigen::Vector3d toward2 = area2 > 0 ? Eigen::Vector3d(normal.cross(edge1) / area2) : Eigen::Vector3d::Zero();
  TextureChart chart;
  chart.material = material;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d slope = (uv[1][axis] - uv[0][axis]) * toward1 + (uv[2][axis] - uv[0][axis]) * toward2;
    Eigen::Vector4f& of = axis == 0 ? chart.u : chart.v;
    of.head<3>() = slope.cast<float>();
    of[3] = static_cast<float>(uv[0][axis] - slope.dot(corners_m[0]));
  }
  return chart;
}

}  // namespace viscera
