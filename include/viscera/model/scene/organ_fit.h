// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"

namespace viscera {

/// How what stands around one organ follows when another takes its place: places from box to box, axis by axis;
/// cameras and tools by a scale each, so that a picture is not sheared and a blade stays straight.
struct OrganFit {
  Eigen::AlignedBox3d from_m, to_m;  ///< boxes of the organs, tissue frame
  Vector3d stretch = Vector3d::Ones();
  double view_scale = 1;  ///< of cameras: the largest stretch and some room, so that the whole organ is seen
  double hand_scale =
      1;  ///< of tools and strokes: the smaller stretch of the face that cameras see, so that they meet it

  /// @param sight  a direction, tissue frame: hands work on the face across the axis that it follows most
  static OrganFit between(const Eigen::AlignedBox3d& from_m, const Eigen::AlignedBox3d& to_m, const Vector3d& sight);
  /// A point [m] of one box at its place in the other.
  Vector3d moved(const Vector3d& point_m) const;
  /// A point [m] around the organ, as cameras move.
  Vector3d viewed(const Vector3d& point_m) const;
  /// Organs that differ so much have no tools in common; a unit of length is wrong, or there is no volume.
  bool isSound() const;
  /// One line for a person.
  std::string text() const;
};

}  // namespace viscera
