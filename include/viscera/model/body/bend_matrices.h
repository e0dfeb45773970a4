// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "viscera/model/shape/solid.h"

namespace viscera {

// A cell that bends, at rest, over mu h^3 and its share (physics.md 1). Hourglass motions s_al are numbers 3 a + l, a
// the edge and l the motion; second differences of displacement u_a along axis n, over h, numbers 3 a + n; strains xx,
// yy, zz, 2 yz, 2 zx, 2 xy.

using BendMatrix = Eigen::Matrix<double, 9, 9>;

/// lambda tr(e) 1 + 2 mu e, over mu.
Eigen::Matrix<double, 6, 6> solidStiffness(double lambda_over_mu);
/// Twice the energy of gradients of strain in tissue of these second moments, by hourglass motions, then second
/// differences.
Eigen::Matrix<double, 18, 18> gradientStiffness(const Eigen::Matrix3d& second, double lambda_over_mu);
/// Second differences by hourglass motions as a cell takes them by itself: strain across a plate that bends is
/// -nu/(1 - nu) of that along it, and no shear goes with it.
BendMatrix missingAlone(double lambda_over_mu);

/// Energy: bends s s / 2 + s strains e.
struct CellBending {
  BendMatrix bends;
  Eigen::Matrix<double, 9, 6> strains;
};
/// @param over_share  moments over the share   @param missing  second differences by hourglass motions
CellBending bendingOf(const CellFill& over_share, double lambda_over_mu, const BendMatrix& missing);

}  // namespace viscera
