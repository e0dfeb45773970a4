// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "viscera/layout/obstacle_motion.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// Factor on a probe's radius: nodes nearer than that to the final sphere are not treated as swept over
/// (shaders/solver/tools/touch.glsl).
constexpr double kOnSphere = 1.001;

/// Contact of a node with a surface in a substep, tissue frame.
struct ObstacleMeeting {
  Vector3d normal;     ///< outward normal
  Vector3d surface_m;  ///< position to which the node is moved
  double offset_m;     ///< displacement of the node in the substep relative to the surface
};

/// Constraint on the end position of a node in a substep of implicit Euler: normal . du >= least.
struct HalfSpace {
  Vector3d normal;
  double least_m;     ///< depth of the node inside before the substep; negative outside
  Vector3d offset_m;  ///< displacement of the surface in the substep
  double friction = 0, restitution = 0;
};

/// A rigid obstacle over a substep (physics.md 8), in float64 from the float32 numbers of the kernels.
class ReferenceObstacle {
 public:
  /// @param dt_s  length of the substep [s]
  ReferenceObstacle(const layout::ObstacleMotion& motion, double dt_s);

  /// Returns the obstacle enlarged for a node at a depth below the surface of its tissue; reduced for one outside.
  ReferenceObstacle enlarged(double below_m) const;
  /// Returns the contact of a node that moves from x to x_next, if it ends inside or passes through.
  std::optional<ObstacleMeeting> meet(const Vector3d& x_m, const Vector3d& x_next_m) const;
  /// Returns the half space in which a node at x must end, if its path would meet the obstacle: the tangent plane
  /// nearest to x; of a box the face that it meets.
  std::optional<HalfSpace> outside(const Vector3d& x_m, const Vector3d& x_next_m) const;
  /// Returns the velocity of the surface at x [m/s].
  Vector3d velocityAt(const Vector3d& x_m) const { return velocity_ + spin_.cross(x_m - to_.position_m); }
  double friction() const { return friction_; }
  double restitution() const { return restitution_; }
  Vector3d position() const { return to_.position_m; }  ///< position at the end of the substep [m]

 private:
  struct Local {
    Vector3d normal, surface_m;
  };
  std::optional<Local> meetPlane(const Vector3d& to) const;
  std::optional<Local> meetBox(const Vector3d& from, const Vector3d& to) const;
  std::optional<Local> meetRound(const Vector3d& from, const Vector3d& to) const;
  Vector3d onAxis(const Vector3d& p) const;
  std::optional<double> entry(const Vector3d& from, const Vector3d& to) const;

  layout::uint shape_;
  double dt_s_, radius_m_, half_length_m_, friction_, restitution_;
  Vector3d half_size_m_, velocity_, spin_;
  Pose from_, to_;
};

/// A sphere in a substep: a probe, or a shaft as tissue at one place meets it.
struct SweptSphere {
  Vector3d from_m, to_m;
  double radius_m;
};
bool pushesByTip(const layout::ToolMotion& motion);
bool pushesByShaft(const layout::ToolMotion& motion);
SweptSphere tipOf(const layout::ToolMotion& motion);
/// Returns the sphere around the point of a shaft's axis that is nearest to x.
SweptSphere shaftNear(const layout::ToolMotion& motion, const Vector3d& x_m);
/// Returns the sphere around the point of a shaft's axis that is nearest to a line; none if the two are almost
/// parallel.
std::optional<SweptSphere> shaftNearLine(const layout::ToolMotion& motion, const Vector3d& x_m, const Vector3d& along);

/// Returns the half space of a sphere that pushes: where a node at x must end a substep if x_next is inside.
/// @param below_m  depth of the node below the surface of its tissue [m]
std::optional<HalfSpace> outsideOfProbe(const SweptSphere& probe, const Vector3d& x_m, const Vector3d& x_next_m,
                                        double below_m);

}  // namespace viscera
