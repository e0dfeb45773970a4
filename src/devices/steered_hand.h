// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// How fast a tip may go that no hand holds.
struct SteeredSpeed {
  double linear_m_per_s = 0.1;
  double angular_rad_per_s = 1.5;
};

/// One step of a tip towards a target that may jump, as a mouse does: straight, at this speed at most.
/// @param dt_s  of the step [s], >= 0
Pose approach(const Pose& from, const Pose& target, const SteeredSpeed& speed, double dt_s);

/// Deflections of a gamepad or a space mouse, -1 .. 1 each.
struct Deflection {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};

/// One step of a tip that deflections drive: along the axes of the frame of its pose, and about them, through the tip.
/// Full deflection of one axis is full speed.
Pose drive(const Pose& from, const Deflection& deflection, const SteeredSpeed& speed, double dt_s);

/// Brings a tip back into a sphere, so that it is never lost.
/// @param centre_m, reach_m  of the sphere, in the frame of the pose
Pose within(const Pose& pose, const Vector3d& centre_m, double reach_m);

/// Which axis of a Joy message does what: `0 -1 4 none none -3` for x, y, z, and turns about them. A minus turns an
/// axis round.
class AxisMap {
 public:
  /// @throws Error  what six words are accepted
  explicit AxisMap(const std::string& text);
  /// @param axes       of the message; those that it lacks are 0, and so is what is not finite
  /// @param dead_zone  deflections up to this are none; from there on they grow from 0 to 1. 0 <= dead_zone < 1
  Deflection deflection(const std::vector<float>& axes, double dead_zone) const;
  /// Does the message have all axes that are asked for?
  bool fits(const std::vector<float>& axes) const;

 private:
  struct Axis {
    size_t index;
    double sign;
  };
  std::array<std::optional<Axis>, 6> axes_;
};

}  // namespace viscera
