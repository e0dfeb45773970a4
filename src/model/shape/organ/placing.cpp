// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/placing.h"

namespace viscera {

Eigen::AlignedBox3d movedBox(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose) {
  const Vector3d half = 0.5 * (max_m - min_m), center = pose * (0.5 * (min_m + max_m));
  const Vector3d reach = pose.orientation.toRotationMatrix().cwiseAbs() * half;
  return {center - reach, center + reach};
}

void moveDetail(TriangleMesh& mesh, const Pose& pose) {
  if (!mesh.detail) return;
  auto moved = std::make_shared<SurfaceDetail>(*mesh.detail);
  const Eigen::Matrix3d turn = pose.orientation.toRotationMatrix();
  for (TextureChart& chart : moved->charts) {
    for (Eigen::Vector4f* of : {&chart.u, &chart.v}) {
      const Vector3d slope = turn * of->head<3>().cast<double>();
      (*of)[3] = static_cast<float>((*of)[3] - slope.dot(pose.position_m));
      of->head<3>() = slope.cast<float>();
    }
  }
  mesh.detail = std::move(moved);
}

DistanceField movedField(const DistanceField& field, const Pose& pose) {
  return [field, to_body = pose.inverse()](const Vector3d& point_m) { return field(to_body * point_m); };
}

}  // namespace viscera
