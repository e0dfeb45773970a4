// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/obstacle_motion.h"
#include "viscera/model/scene/suture_config.h"

namespace viscera {

/// The arc of a needle in its own frame: about the y axis, with its tip on the x axis and pointing along z. Positions
/// on it are given as arc length behind the tip.
class NeedleShape {
 public:
  NeedleShape(double radius_m, double angle_rad, double wire_radius_m)
      : radius_m_(radius_m), angle_rad_(angle_rad), wire_radius_m_(wire_radius_m) {}
  explicit NeedleShape(const NeedleConfig& config);

  double length_m() const { return radius_m_ * angle_rad_; }
  double radius_m() const { return radius_m_; }
  double wireRadius_m() const { return wire_radius_m_; }
  Vector3d at(double behind_m) const;
  /// Returns the unit tangent towards the tip.
  Vector3d forward(double behind_m) const;
  /// Returns the arc length of the nearest point of the whole circle: negative ahead of the tip, above the length
  /// beyond the tail.
  double nearest_m(const Vector3d& own_m) const;
  /// Returns the centre of mass of the wire.
  Vector3d middle() const;
  double mass_kg() const;  ///< mass of steel
  /// Returns the moment of inertia about any axis through the centre of mass, approximated by that of a ring about a
  /// diameter.
  double inertia_kg_m2() const { return 0.5 * mass_kg() * radius_m_ * radius_m_; }
  /// Returns the pose with the tail at a position.
  Pose withTailAt(const Vector3d& tail_m, const Quaterniond& orientation) const;
  static constexpr size_t kShown = 33;  ///< number of points with which it is drawn
  /// Returns points along it, from the tip to the tail.
  std::vector<Vector3d> positions(const Pose& pose, size_t count = kShown) const;

 private:
  double radius_m_, angle_rad_, wire_radius_m_;
};

/// Moves a needle to a pose, in steps so short that it does not tunnel, and out of obstacles that it is in.
/// @param obstacles  [count] at the end of the substep   @returns the pose that it reaches
Pose keptOut(const NeedleShape& shape, const Pose& from, const Pose& to, const layout::ObstacleMotion* obstacles,
             uint32_t count);

}  // namespace viscera
