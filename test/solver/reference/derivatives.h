// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/reference/reference_lattice.h"

namespace viscera::test {

constexpr double kStep = 1e-5;       ///< step of numerical derivatives, in spacings: the best for central differences
constexpr double kAgreement = 1e-6;  ///< error of numerical derivatives, over the largest value

/// Compares every force with the slope of the energy. Returns the largest difference over the largest force.
inline double forceError(const ReferenceLattice& lattice, const Field& u_m, double spacing_m) {
  const Field forces = lattice.elasticForces(u_m);
  double error = 0, largest = 0;
  Field moved = u_m;
  for (uint32_t slot : lattice.active) {
    for (int axis = 0; axis < 3; ++axis) {
      const double step = kStep * spacing_m;
      moved[slot][axis] = u_m[slot][axis] + step;
      const double above = lattice.elasticEnergy(moved);
      moved[slot][axis] = u_m[slot][axis] - step;
      const double below = lattice.elasticEnergy(moved);
      moved[slot][axis] = u_m[slot][axis];
      error = std::max(error, std::abs(forces[slot][axis] + (above - below) / (2 * step)));
      largest = std::max(largest, std::abs(forces[slot][axis]));
    }
  }
  return error / largest;
}

/// Compares every entry of the stiffness matrix with the slope of the forces. Returns the largest difference over the
/// largest entry.
inline double stiffnessError(const ReferenceLattice& lattice, const Field& u_m, double spacing_m) {
  const Eigen::MatrixXd k = lattice.stiffnessMatrix(u_m);
  double error = 0;
  Field moved = u_m;
  for (uint32_t slot : lattice.active) {
    for (int axis = 0; axis < 3; ++axis) {
      const double step = kStep * spacing_m;
      moved[slot][axis] = u_m[slot][axis] + step;
      const Field above = lattice.elasticForces(moved);
      moved[slot][axis] = u_m[slot][axis] - step;
      const Field below = lattice.elasticForces(moved);
      moved[slot][axis] = u_m[slot][axis];
      for (uint32_t other : lattice.active) {
        const Vector3d slope = (below[other] - above[other]) / (2 * step);
        const Vector3d column = k.col(lattice.dof(slot, axis)).segment<3>(lattice.dof(other, 0));
        error = std::max(error, (slope - column).norm());
      }
    }
  }
  return error / k.cwiseAbs().maxCoeff();
}

}  // namespace viscera::test
