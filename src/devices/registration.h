// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/pivot.h"

namespace viscera {

/// A point of the tissue frame that a stylus is to touch.
struct KnownPoint {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
};

/// Where the base of a device is, found by touching known points.
struct Registration {
  Pose base;                        ///< the frame of the device's poses, in the tissue frame
  double residual_m;                ///< root mean square of the distances below
  std::vector<double> distances_m;  ///< [points] of each touched point, brought to the tissue frame, from the known one
};

struct RegistrationLimits {
  double residual_m = 0.003;
};

constexpr size_t kLeastPoints = 3;
/// Points must spread in two directions: RMS distance from the line that fits them best. Below it a turn about that
/// line is a guess.
constexpr double kLeastSpread_m = 0.005;

/// The rigid motion that takes touched points to the known ones with the least sum of squares, by SVD (Umeyama,
/// "Least-squares estimation of transformation parameters between two point patterns", 1991, without scale: Arun, Huang
/// and Blostein's fit that never mirrors). With independent errors of sigma per coordinate the residual is about sigma
/// sqrt(3 - 6 / points).
/// @param known    [N] tissue frame
/// @param touched  [N] where the tip was at each, in the frame of the device's poses
/// @throws RegistrationError  too few points, points on a line, a residual above the limit; names the worst point
Registration solveRegistration(const std::vector<KnownPoint>& known, const std::vector<Vector3d>& touched,
                               const RegistrationLimits& limits);

/// "apex 0.31, base 0.52": distances in mm by the points' names.
std::string distancesText(const std::vector<KnownPoint>& known, const Registration& registration);

}  // namespace viscera
