// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Map from the environment of one organ to those of another that replaces it. Positions are mapped from box to box,
/// axis by axis. Cameras and tools have one scale each, so that images are not sheared and blades stay straight.
struct OrganFit {
  Eigen::AlignedBox3d from_m, to_m;  ///< bounding boxes of the organs, tissue frame [m]
  Vector3d stretch = Vector3d::Ones();
  double view_scale = 1;  ///< scale of cameras: the largest stretch and a margin, so that the whole organ is visible
  double tool_scale = 1;  ///< scale of tools and strokes: the smaller stretch of the face that cameras see

  /// Returns the map between two boxes.
  /// @param sight  viewing direction, tissue frame: tools work on the face across the axis nearest to it
  static OrganFit between(const Eigen::AlignedBox3d& from_m, const Eigen::AlignedBox3d& to_m, const Vector3d& sight);
  /// Returns the position in the other box of a point [m] of the first.
  Vector3d moved(const Vector3d& point_m) const;
  /// Returns the position of a point [m] around the organ, mapped as cameras are.
  Vector3d viewed(const Vector3d& point_m) const;
  /// Returns whether tools can serve both organs. If the sizes differ too much, a unit of length is wrong or there is
  /// no volume.
  bool isSound() const;
  /// Returns one line for a person.
  std::string text() const;
};

}  // namespace viscera
