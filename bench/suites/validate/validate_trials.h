// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace viscera::bench {

/// A cylinder of 50 mm width and 30 mm height between frictionless plates, in a scene as users have it. Springs are
/// linear, so stress is E times a function of strain: one run is valid for all E.
struct Compression {
  std::vector<double> strain;         ///< ascending from 0
  std::vector<double> stress_over_e;  ///< [strain] engineering stress over E, mean of both plates
  double at(double at_strain) const;
};
/// Compresses the cylinder.
/// @param poisson_ratio  of the material   @param spacing_m  divisor of the height   @throws Error
Compression compressedCylinder(double poisson_ratio, double spacing_m, double most_strain);

/// A sphere that is pushed into the centre of a block of 10 radii across and 5 high, fixed at its bottom.
struct SpherePress {
  std::vector<double> depth_over_r;  ///< ascending
  std::vector<double> over_hertz;    ///< [depth] force over 4/3 E / (1 - nu^2) sqrt(R) D^1.5
};
/// Presses the sphere. @param radius  [spacings]
SpherePress pressedSphere(double poisson_ratio, int radius, const std::vector<double>& depths);

}  // namespace viscera::bench
