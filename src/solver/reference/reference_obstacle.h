// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "viscera/layout/obstacle_motion.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// Of a probe's radius: so near to the final sphere nothing is seen as swept over (shaders/solver/tools/touch.glsl).
constexpr double kOnSphere = 1.001;

/// A surface that a node meets in a substep, tissue frame.
struct ObstacleMeeting {
  Vector3d normal;     ///< out of it
  Vector3d surface_m;  ///< where the node goes
  double way_m;        ///< of the node in the substep, as seen from the surface
};

/// Where a node must end a substep of implicit Euler: normal . du >= least.
struct HalfSpace {
  Vector3d normal;
  double least_m;  ///< how far the node is inside before; below 0 outside
  Vector3d way_m;  ///< of the surface in the substep
  double friction = 0, restitution = 0;
};

/// A rigid obstacle over a substep (physics.md 8), in float64 from the numbers that kernels get.
class ReferenceObstacle {
 public:
  /// @param dt_s  the substep's length
  ReferenceObstacle(const layout::ObstacleMotion& motion, double dt_s);

  /// As a node sees it that lies so deep below the surface of its tissue, or outside of it: larger or smaller.
  ReferenceObstacle enlarged(double below_m) const;
  /// Does a node that goes from x to x_next end inside, or pass through?
  std::optional<ObstacleMeeting> meet(const Vector3d& x_m, const Vector3d& x_next_m) const;
  /// The half space that a node at x must end in if its way would meet the obstacle: the tangent plane nearest to x, of
  /// a box the face that it meets.
  std::optional<HalfSpace> outside(const Vector3d& x_m, const Vector3d& x_next_m) const;
  /// Of the surface where it is at x [m/s].
  Vector3d velocityAt(const Vector3d& x_m) const { return velocity_ + spin_.cross(x_m - to_.position_m); }
  double friction() const { return friction_; }
  double restitution() const { return restitution_; }
  Vector3d place() const { return to_.position_m; }  ///< at the end of the substep [m]

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

/// The same of a probe that pushes: where a node at x must end a substep if x_next is inside.
/// @param below_m  how deep the node lies below the surface of its tissue
std::optional<HalfSpace> outsideOfProbe(const layout::ToolMotion& motion, const Vector3d& x_m, const Vector3d& x_next_m,
                                        double below_m);

}  // namespace viscera
