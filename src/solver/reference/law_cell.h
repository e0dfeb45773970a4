// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/tissue/law_laminate.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// How a cell moves (physics.md 1): mean edges less their rest value, hourglass motions, and the alternating one, over
/// h; nine, nine and three numbers.
using CellMotion = Eigen::Matrix<double, 21, 1>;
/// @param u_m  displacements of the corners: bit 0 of the index x, bit 1 y, bit 2 z
CellMotion cellMotion(const std::array<Vector3d, 8>& u_m, double spacing_m);
/// d motion / d displacement of a corner is this times the axis, for each of the seven vectors of the motion [1/m].
Eigen::Matrix<double, 7, 1> motionOfCorner(size_t corner, double spacing_m);

/// A cell that obeys the neo-Hookean law (law_energy.h).
struct LawCell {
  double rigidity_j = 0;                                ///< mu h^3 times its share; 0: there is no such cell
  double bulk_j = 0;                                    ///< (lambda - mu) h^3 times its share
  double stiffening = 0;                                ///< b of lawShear()
  CellFill fill;                                        ///< over its share, which is 1
  LawLaminate laminate;                                 ///< its two materials; exists() only where it has two
  Eigen::Matrix3d prestress = Eigen::Matrix3d::Zero();  ///< its stress at rest over mu
};

/// Returns the energy of a cell [J].
double lawCellEnergy(const LawCell& cell, const CellMotion& motion);
/// Returns d energy / d motion [J], exact: by automatic differentiation of the energy as it is written.
CellMotion lawCellGradient(const LawCell& cell, const CellMotion& motion);
/// Returns d2 energy / d motion2 [J], by differences of the gradient: to 1e-7 of its largest.
Eigen::Matrix<double, 21, 21> lawCellCurvature(const LawCell& cell, const CellMotion& motion);

}  // namespace viscera
