// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "model/shape/organ/tissue.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

// Transforms from a file's or a shape's own coordinates to the tissue frame.

template <class Vector>
void move(std::vector<Vector>& points_m, const Pose& pose) {
  for (Vector& p : points_m) {
    const Vector3d moved = pose * p.template cast<double>();
    p = moved.cast<typename Vector::Scalar>();
  }
}

/// Turns the file's upward axis to z and moves the centre of its bounding box to the origin, if configured.
/// @returns pose of the body's frame in the file's, so that other files can be placed in the same way
template <class Vector>
Pose toBodyFrame(std::vector<Vector>& points_m, const BodyConfig& config) {
  Pose placed;
  if (config.up_axis == UpAxis::kY) {
    for (Vector& p : points_m) p = Vector(p.x(), -p.z(), p.y());
    placed.orientation = rotationFromDegrees({90, 0, 0});
  }
  if (!config.centered) return placed;
  Eigen::AlignedBox<typename Vector::Scalar, 3> box;
  for (const Vector& p : points_m) box.extend(p);
  const Vector middle = box.center();
  for (Vector& p : points_m) p -= middle;
  placed.position_m = -middle.template cast<double>();
  return placed;
}

/// Moves the charts of a mesh along with its points.
void moveDetail(TriangleMesh& mesh, const Pose& pose);

template <class Vector>
Eigen::AlignedBox3d boundsOf(const std::vector<Vector>& points_m) {
  Eigen::AlignedBox3d box;
  for (const Vector& p : points_m) box.extend(p.template cast<double>());
  return box;
}

/// Returns the box around a rotated and moved box.
Eigen::AlignedBox3d movedBox(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose);
DistanceField movedField(const DistanceField& field, const Pose& pose);

}  // namespace viscera
