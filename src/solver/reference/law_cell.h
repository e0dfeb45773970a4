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

/// How a cell in a thin wall moves: CellMotion; then second derivatives along its axes, the means over its corners of
/// second differences of rows of nodes; then these differences' means over the face at one side less that at the other,
/// by axis of the row and axis of the sides xy, xz, yz, yx, zx, zy; over h.
using WallMotion = Eigen::Matrix<double, 48, 1>;

/// What a cell in a thin wall has of WallCell.
struct LawWall {
  Vector3d normal = Vector3d::Zero();  ///< unit
  Vector3d rows = Vector3d::Zero();    ///< share of second derivatives along an axis that comes from rows
  double across = 0;                   ///< share of the stress across the wall that is free, of its gradient
  double variation = 0;                ///< share of their variation
};

/// A cell that obeys the neo-Hookean law (law_energy.h).
struct LawCell {
  double rigidity_j = 0;                                ///< mu h^3 times its share; 0: there is no such cell
  double bulk_j = 0;                                    ///< (lambda - mu) h^3 times its share
  double stiffening = 0;                                ///< b of lawShear()
  CellFill fill;                                        ///< over its share, which is 1
  LawLaminate laminate;                                 ///< its two materials; exists() only where it has two
  LawWall wall;                                         ///< of cells in thin walls
  Eigen::Matrix3d prestress = Eigen::Matrix3d::Zero();  ///< its stress at rest over mu
};

/// Returns the energy of a cell [J].
double lawCellEnergy(const LawCell& cell, const CellMotion& motion);
double lawCellEnergy(const LawCell& cell, const WallMotion& motion);
/// Returns d energy / d motion [J], exact: by automatic differentiation of the energy as it is written.
CellMotion lawCellGradient(const LawCell& cell, const CellMotion& motion);
WallMotion lawCellGradient(const LawCell& cell, const WallMotion& motion);
/// Returns d2 energy / d motion2 [J], by differences of the gradient: to 1e-7 of its largest.
Eigen::Matrix<double, 21, 21> lawCellCurvature(const LawCell& cell, const CellMotion& motion);
Eigen::Matrix<double, 48, 48> lawCellCurvature(const LawCell& cell, const WallMotion& motion);

}  // namespace viscera
