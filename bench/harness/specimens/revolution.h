// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::bench {

/// A body of revolution of linear elastic stuff and a load on it that turns with cos(waves theta): what lattices are
/// held to where nothing closed is known.
struct Revolution {
  /// (s, t) in the unit square -> (r, z) of the half section [m].
  std::function<Eigen::Vector2d(double s, double t)> section;
  int across = 4, along = 24;  ///< elements along s and t; a solution is known to 1e-3 where twice as many change less
  int waves = 0;               ///< of load and displacement around the axis
  /// Force per volume at (r, z) [N/m3]: radial and axial part times cos(waves theta), around the axis times sin.
  std::function<Vector3d(double r, double z)> load;
  double young_modulus_pa = 1, poisson_ratio = 0.25;
};

/// Load times displacement, integrated over the free body [J], by triquadratic elements in the half section and one
/// harmonic around it. The load must leave no net force or torque.
double continuumCompliance(const Revolution& body);

}  // namespace viscera::bench
