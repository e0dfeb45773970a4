// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/law_cell.h"

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "solver/reference/law_energy.h"

namespace viscera {

namespace {

template <class T, int N>
T energyOf(const LawCell& cell, const Eigen::Matrix<T, N, 1>& motion) {
  return cell.rigidity_j * lawEnergy<T, N>(cell.bulk_j / cell.rigidity_j, cell, motion);
}

template <int N>
Eigen::Matrix<double, N, 1> gradientOf(const LawCell& cell, const Eigen::Matrix<double, N, 1>& motion) {
  using Motion = Eigen::Matrix<double, N, 1>;
  if (cell.rigidity_j == 0) return Motion::Zero();
  using Dual = Eigen::AutoDiffScalar<Motion>;
  Eigen::Matrix<Dual, N, 1> dual;
  for (int i = 0; i < N; ++i) dual[i] = Dual(motion[i], N, i);
  return energyOf<Dual, N>(cell, dual).derivatives();
}

template <int N>
Eigen::Matrix<double, N, N> curvatureOf(const LawCell& cell, const Eigen::Matrix<double, N, 1>& motion) {
  constexpr double kStep = 1e-6;  // of the spacing: loses half the digits of the gradient
  Eigen::Matrix<double, N, N> out;
  for (int i = 0; i < N; ++i) {
    Eigen::Matrix<double, N, 1> up = motion, down = motion;
    up[i] += kStep;
    down[i] -= kStep;
    out.col(i) = (gradientOf<N>(cell, up) - gradientOf<N>(cell, down)) / (2 * kStep);
  }
  return 0.5 * (out + out.transpose());
}

}  // namespace

Eigen::Matrix<double, 7, 1> motionOfCorner(size_t corner, double spacing_m) {
  const double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1, z = corner & 4 ? 1 : -1;
  Eigen::Matrix<double, 7, 1> out;
  out << x / 4, y / 4, z / 4, y * z / 2, z * x / 2, x * y / 2, x * y * z / std::sqrt(8.0);
  return out / spacing_m;
}

CellModes cellMotion(const std::array<Vector3d, 8>& u_m, double spacing_m) {
  CellModes out = CellModes::Zero();
  for (size_t c = 0; c < 8; ++c) {
    const Eigen::Matrix<double, 7, 1> of_corner = motionOfCorner(c, spacing_m);
    for (int i = 0; i < 7; ++i) out.segment<3>(3 * i) += of_corner[i] * u_m[c];
  }
  return out;
}

double lawCellEnergy(const LawCell& cell, const CellModes& motion) {
  return cell.rigidity_j == 0 ? 0 : energyOf<double, 21>(cell, motion);
}
double lawCellEnergy(const LawCell& cell, const WallMotion& motion) {
  return cell.rigidity_j == 0 ? 0 : energyOf<double, 48>(cell, motion);
}

CellModes lawCellGradient(const LawCell& cell, const CellModes& motion) {
  return gradientOf<21>(cell, motion);
}
WallMotion lawCellGradient(const LawCell& cell, const WallMotion& motion) {
  return gradientOf<48>(cell, motion);
}

Eigen::Matrix<double, 21, 21> lawCellCurvature(const LawCell& cell, const CellModes& motion) {
  return curvatureOf<21>(cell, motion);
}
Eigen::Matrix<double, 48, 48> lawCellCurvature(const LawCell& cell, const WallMotion& motion) {
  return curvatureOf<48>(cell, motion);
}

}  // namespace viscera
