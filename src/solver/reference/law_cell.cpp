// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/law_cell.h"

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "solver/reference/law_energy.h"

namespace viscera {

namespace {

template <class T>
T energyOf(const LawCell& cell, const Eigen::Matrix<T, 21, 1>& motion) {
  return cell.rigidity_j *
         lawEnergy<T>(cell.bulk_j / cell.rigidity_j, cell.stiffening, cell.fill, cell.laminate, cell.prestress, motion);
}

}  // namespace

Eigen::Matrix<double, 7, 1> motionOfCorner(size_t corner, double spacing_m) {
  const double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1, z = corner & 4 ? 1 : -1;
  Eigen::Matrix<double, 7, 1> out;
  out << x / 4, y / 4, z / 4, y * z / 2, z * x / 2, x * y / 2, x * y * z / std::sqrt(8.0);
  return out / spacing_m;
}

CellMotion cellMotion(const std::array<Vector3d, 8>& u_m, double spacing_m) {
  CellMotion out = CellMotion::Zero();
  for (size_t c = 0; c < 8; ++c) {
    const Eigen::Matrix<double, 7, 1> of_corner = motionOfCorner(c, spacing_m);
    for (int i = 0; i < 7; ++i) out.segment<3>(3 * i) += of_corner[i] * u_m[c];
  }
  return out;
}

double lawCellEnergy(const LawCell& cell, const CellMotion& motion) {
  return cell.rigidity_j == 0 ? 0 : energyOf<double>(cell, motion);
}

CellMotion lawCellGradient(const LawCell& cell, const CellMotion& motion) {
  if (cell.rigidity_j == 0) return CellMotion::Zero();
  using Dual = Eigen::AutoDiffScalar<CellMotion>;
  Eigen::Matrix<Dual, 21, 1> dual;
  for (int i = 0; i < 21; ++i) dual[i] = Dual(motion[i], 21, i);
  return energyOf<Dual>(cell, dual).derivatives();
}

Eigen::Matrix<double, 21, 21> lawCellCurvature(const LawCell& cell, const CellMotion& motion) {
  constexpr double kStep = 1e-6;  // of the spacing: halves the digits of the gradient
  Eigen::Matrix<double, 21, 21> out;
  for (int i = 0; i < 21; ++i) {
    CellMotion up = motion, down = motion;
    up[i] += kStep;
    down[i] -= kStep;
    out.col(i) = (lawCellGradient(cell, up) - lawCellGradient(cell, down)) / (2 * kStep);
  }
  return 0.5 * (out + out.transpose());
}

}  // namespace viscera
