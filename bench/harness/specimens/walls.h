// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

/// A free solid of E = 1 Pa under a load that leaves no net force or torque, in axes of its own.
struct Wall {
  std::string name;
  double thickness_m = 1;  ///< of what bends
  std::function<bool(const Vector3d& at_m)> inside;
  std::function<Vector3d(const Vector3d& at_m)> load_n_per_m3;
  Vector3d half_m;                                     ///< of its box about the origin
  std::function<double(double poisson_ratio)> true_j;  ///< load times displacement in the continuum [J]
};

/// Where it lies in the grid.
struct Placing {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vector3d shift = Vector3d::Zero();  ///< [spacings] 0..1
};
/// 30, 24 and 17 degrees about z, y and x: along no axis or diagonal.
Eigen::Matrix3d turned();

struct BentWall {
  size_t nodes = 0;
  std::optional<double> excess;  ///< compliance over the true one, less 1; nothing where the lattice falls apart
  /// [backends] u . f of the kernels' forces in the reference's equilibrium over that of the reference, less 1.
  std::vector<double> on;
  /// [watched] displacements in the wall's axes [m]; not finite where no cell is, empty where the lattice falls apart.
  Field moved_m;
};

/// The wall in cells of the neo-Hookean law, each with the moments of what it holds of it, from a share of 1e-2 on,
/// bent by its load in float64 statics; displacements infinitesimal.
/// @param backends  whose forces are looked at   @param watched_m  places in the wall's axes
BentWall bendWall(const Wall& wall, const Placing& placing, double spacing_m, double poisson_ratio,
                  const std::vector<Backend>& backends = {}, const std::vector<Vector3d>& watched_m = {});

}  // namespace viscera::bench
