// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

/// A free solid with E = 1 Pa under a load without net force or torque, in its own axes.
struct Wall {
  std::string name;
  double thickness_m = 1;  ///< thickness of the bending part [m]
  std::function<bool(const Vector3d& at_m)> inside;
  std::function<Vector3d(const Vector3d& at_m)> load_n_per_m3;
  Vector3d half_m;                                     ///< half of its bounding box, which is centred on the origin [m]
  std::function<double(double poisson_ratio)> true_j;  ///< load times displacement in the continuum [J]
};

/// Position of a wall in the grid.
struct Placing {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vector3d shift = Vector3d::Zero();  ///< offset in spacings, 0..1
};
/// Returns a rotation of 30, 24 and 17 degrees about z, y and x, which is along no axis or diagonal.
Eigen::Matrix3d turned();

struct BentWall {
  size_t nodes = 0;
  std::optional<double> excess;  ///< compliance relative to the true one, minus 1; empty if the lattice falls apart
  /// [backends] u . f of the kernels' forces in the reference's equilibrium relative to that of the reference, minus 1.
  std::vector<double> on;
  /// [watched] displacements in the wall's axes [m]; not finite outside the cells, empty if the lattice falls apart.
  Field moved_m;
};

/// Curvatures a wall of neo-Hookean cells by its load in float64 statics, with infinitesimal displacements. Each cell
/// has the moments of the part that it contains, from a share of 1e-2 on.
/// @param backends  backends to evaluate forces on   @param watched_m  positions in the wall's axes
BentWall bendWall(const Wall& wall, const Placing& placing, double spacing_m, double poisson_ratio,
                  const std::vector<Backend>& backends = {}, const std::vector<Vector3d>& watched_m = {});

}  // namespace viscera::bench
