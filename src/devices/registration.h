// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/pivot.h"

namespace viscera {

/// A point of the tissue frame for the stylus to touch.
struct KnownPoint {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
};

/// The base of a device, registered by touching known points.
struct Registration {
  Pose base;                        ///< pose of the frame of the device's poses, in the tissue frame
  double residual_m;                ///< root mean square of the distances below [m]
  std::vector<double> distances_m;  ///< [points] distance of each touched point from the known one [m]
};

struct RegistrationLimits {
  double residual_m = 0.003;
};

constexpr size_t kLeastPoints = 3;
/// Least accepted spread of the points in two directions: RMS distance from the line of best fit. Below it the rotation
/// about that line is not determined.
constexpr double kLeastSpread_m = 0.005;

/// Finds the rigid transform from touched to known points with the least sum of squares, by SVD (Umeyama,
/// "Least-squares estimation of transformation parameters between two point patterns", 1991, without scale: the fit of
/// Arun, Huang and Blostein without reflections). With independent errors of sigma per coordinate the residual is about
/// sigma sqrt(3 - 6 / points).
/// @param known    [N] tissue frame
/// @param touched  [N] position of the tip at each point, in the frame of the device's poses
/// @throws RegistrationError  too few points, collinear points, or a residual above the limit; names the worst point
Registration solveRegistration(const std::vector<KnownPoint>& known, const std::vector<Vector3d>& touched,
                               const RegistrationLimits& limits);

/// Returns a text such as "apex 0.31, base 0.52": distances in mm by the points' names.
std::string distancesText(const std::vector<KnownPoint>& known, const Registration& registration);

}  // namespace viscera
