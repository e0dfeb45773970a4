// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/render/camera.h"

namespace viscera {

/// Visible volume of a camera: six planes, tissue frame.
class Frustum {
 public:
  explicit Frustum(const CameraConfig& camera) : Frustum(camera, opticalPose(camera)) {}
  /// Makes the frustum of a camera at another pose. @param tissue_from_optical  pose of its optical frame
  Frustum(const CameraConfig& camera, const Pose& tissue_from_optical);

  /// Returns whether no part of the box is in the image. Conservative: false for every box that may be in it. True for
  /// an empty box.
  bool misses(const Eigen::AlignedBox3f& box) const;

 private:
  struct Plane {  ///< inwards . x >= at
    Vector3f inwards;
    float at_m;
  };
  std::array<Plane, 6> planes_;
};

}  // namespace viscera
