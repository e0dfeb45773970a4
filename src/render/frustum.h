// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/render/camera.h"

namespace viscera {

/// What a camera can see: six planes, tissue frame.
class Frustum {
 public:
  explicit Frustum(const CameraConfig& camera) : Frustum(camera, opticalPose(camera)) {}
  /// Of a camera that is elsewhere. @param tissue_from_optical  pose of its optical frame
  Frustum(const CameraConfig& camera, const Pose& tissue_from_optical);

  /// Is nothing of the box in the picture? Never said of a box that may be in it; an empty box is missed.
  bool misses(const Eigen::AlignedBox3f& box) const;

 private:
  struct Plane {  ///< inwards . x >= at
    Vector3f inwards;
    float at_m;
  };
  std::array<Plane, 6> planes_;
};

}  // namespace viscera
