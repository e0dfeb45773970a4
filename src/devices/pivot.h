// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera {

/// Error for poses or points of a registration that are degenerate or inconsistent. States what is required.
struct RegistrationError : Error {
  using Error::Error;
};

/// The tip of a stylus, calibrated by rotating the device about it.
struct Pivot {
  Vector3d tip_m;     ///< offset of the tip in the frame of the device's pose
  Vector3d pivot_m;   ///< position of the tip, in the frame of the poses [m]
  double residual_m;  ///< root mean square of the distance of a pose's tip from the pivot [m]
  double turned;      ///< RMS travel of the device per metre of tip, in the direction of least rotation; at most 1
};

struct PivotLimits {
  double residual_m = 0.003;
};

/// Least accepted `Pivot::turned`. An offset along the direction of least rotation has an error `1 / turned` times that
/// of the poses. 0.1 is a cone of about 6 degrees about the mean: an error of 0.1 mm in the poses becomes 1 mm in the
/// tip.
constexpr double kLeastTurned = 0.1;
constexpr size_t kLeastPivotPoses = 20;  ///< six unknowns, and enough further poses for a meaningful residual

/// Solves R_i t + p_i = p for tip t and pivot p over all poses by least squares (Yaniv, "Which pivot calibration?",
/// 2015: the algebraic one-step method).
/// @param poses  of the device while its tip is fixed, at least kLeastPivotPoses; unit quaternions
/// @throws RegistrationError  too few poses, too little rotation, or a residual above the limit
Pivot solvePivot(const std::vector<Pose>& poses, const PivotLimits& limits);

}  // namespace viscera
