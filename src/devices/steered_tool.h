// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Speed limits of a tip that no user holds.
struct SteeredSpeed {
  double linear_m_per_s = 0.1;
  double angular_rad_per_s = 1.5;
};

/// Advances a tip towards a target that may jump, as a mouse does: along a straight line, within the speed limits.
/// @param dt_s  length of the step [s], >= 0
Pose approach(const Pose& from, const Pose& target, const SteeredSpeed& speed, double dt_s);

/// Deflections of a gamepad or a space mouse, -1 .. 1 each.
struct Deflection {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};

/// Advances a tip by deflections: along the axes of the frame of its pose, and about these axes through the tip. Full
/// deflection of one axis is full speed.
Pose drive(const Pose& from, const Deflection& deflection, const SteeredSpeed& speed, double dt_s);

/// Moves a tip back into a sphere, so that it is never lost.
/// @param centre_m, reach_m  centre and radius, in the frame of the pose
Pose within(const Pose& pose, const Vector3d& centre_m, double reach_m);

/// Assigns the axes of a Joy message: `0 -1 4 none none -3` for x, y, z, and rotations about them. A minus reverses an
/// axis.
class AxisMap {
 public:
  /// @throws Error  names the six accepted words
  explicit AxisMap(const std::string& text);
  /// Returns the deflections.
  /// @param axes       axes of the message; missing ones and ones that are not finite are 0
  /// @param dead_zone  deflections up to this are 0; from there on they grow from 0 to 1. 0 <= dead_zone < 1
  Deflection deflection(const std::vector<float>& axes, double dead_zone) const;
  /// Returns whether the message has all assigned axes.
  bool fits(const std::vector<float>& axes) const;

 private:
  struct Axis {
    size_t index;
    double sign;
  };
  std::array<std::optional<Axis>, 6> axes_;
};

}  // namespace viscera
