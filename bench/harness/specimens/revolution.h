// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::bench {

/// A linear elastic body of revolution under a load that varies with cos(waves theta): a reference for lattices where
/// there is no closed-form solution.
struct Revolution {
  /// Maps (s, t) in the unit square to (r, z) of the half section [m].
  std::function<Eigen::Vector2d(double s, double t)> section;
  int across = 4, along = 24;  ///< number of elements along s and t; a solution is accurate to 1e-3 if doubling them
                               ///< changes it by less
  int waves = 0;               ///< circumferential wave number of load and displacement
  /// Returns the force per volume at (r, z) [N/m3]: the radial and axial components times cos(waves theta), the
  /// circumferential one times sin.
  std::function<Vector3d(double r, double z)> load;
  double young_modulus_pa = 1, poisson_ratio = 0.25;
};

/// Returns load times displacement, integrated over the free body [J], with triquadratic elements in the half section
/// and one harmonic around the axis. The load must have no net force or torque.
double continuumCompliance(const Revolution& body);

}  // namespace viscera::bench
