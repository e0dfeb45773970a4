// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera {

/// Poses or points of a registration that determine nothing, or contradict each other. Says what would do.
struct RegistrationError : Error {
  using Error::Error;
};

/// Where the tip of a stylus is, found by turning the device about it.
struct Pivot {
  Vector3d tip_m;     ///< offset of the tip in the frame of the device's pose
  Vector3d pivot_m;   ///< where the tip stood, in the frame of the poses
  double residual_m;  ///< root mean square of the distance of a pose's tip from the pivot
  double turned;      ///< RMS travel of the device per metre of tip, in the direction that was turned least; 1 at most
};

struct PivotLimits {
  double residual_m = 0.003;
};

/// Least that `Pivot::turned` may be. An offset along the direction that was turned least is found `1 / turned` times
/// worse than the poses are: 0.1 is a cone of some 6 degrees about the mean, where an error of 0.1 mm in the poses is
/// one of 1 mm in the tip.
constexpr double kLeastTurned = 0.1;
constexpr size_t kLeastPivotPoses = 20;  ///< six unknowns, and enough beside them that the residual says something

/// Least squares for tip t and pivot p of R_i t + p_i = p over all poses (Yaniv, "Which pivot calibration?", 2015: the
/// algebraic one-step method).
/// @param poses  of the device while its tip stands still, at least kLeastPivotPoses; unit quaternions
/// @throws RegistrationError  too few poses, turned too little, or a residual above the limit
Pivot solvePivot(const std::vector<Pose>& poses, const PivotLimits& limits);

}  // namespace viscera
