// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/tissue/law_laminate.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Deformation modes of a cell (physics.md 1): mean edges less their rest value, hourglass modes, and the alternating
/// mode, over h; nine, nine and three numbers.
using CellModes = Eigen::Matrix<double, 21, 1>;
/// Returns the modes. @param u_m  displacements of the corners: bit 0 of the index x, bit 1 y, bit 2 z
CellModes cellMotion(const std::array<Vector3d, 8>& u_m, double spacing_m);
/// Returns the derivative of the modes by the displacement of a corner: d mode / d u is this times the axis, for each
/// of the seven vectors [1/m].
Eigen::Matrix<double, 7, 1> motionOfCorner(size_t corner, double spacing_m);

/// Deformation modes of a cell in a thin wall. First CellModes. Then second derivatives along its axes: means over its
/// corners of the second differences of rows of nodes. Then the differences of these means between opposite faces,
/// ordered by axis of the row and axis of the sides: xy, xz, yz, yx, zx, zy. All over h.
using WallMotion = Eigen::Matrix<double, 48, 1>;

/// The data of a WallCell that the law uses.
struct LawWall {
  Vector3d normal = Vector3d::Zero();  ///< unit
  Vector3d rows = Vector3d::Zero();    ///< share of second derivatives along an axis that is taken from rows
  double across = 0;                   ///< share of the gradient of the stress across the wall that is relieved
  double variation = 0;                ///< share of their variation
};

/// A cell that obeys the neo-Hookean law (law_energy.h).
struct LawCell {
  double rigidity_j = 0;                                ///< mu h^3 times its share; 0: there is no such cell
  double bulk_j = 0;                                    ///< (lambda - mu) h^3 times its share
  double stiffening = 0;                                ///< b of lawShear()
  CellFill fill;                                        ///< fill of the cell over its share, which is 1
  LawLaminate laminate;                                 ///< materials of a cell with two; exists() only then
  LawWall wall;                                         ///< data of cells in thin walls
  Eigen::Matrix3d prestress = Eigen::Matrix3d::Zero();  ///< stress at rest over mu
};

/// Returns the energy of a cell [J].
double lawCellEnergy(const LawCell& cell, const CellModes& motion);
double lawCellEnergy(const LawCell& cell, const WallMotion& motion);
/// Returns d energy / d modes [J], exactly, by automatic differentiation of the energy.
CellModes lawCellGradient(const LawCell& cell, const CellModes& motion);
WallMotion lawCellGradient(const LawCell& cell, const WallMotion& motion);
/// Returns d2 energy / d modes2 [J], by differences of the gradient: to 1e-7 of its largest entry.
Eigen::Matrix<double, 21, 21> lawCellCurvature(const LawCell& cell, const CellModes& motion);
Eigen::Matrix<double, 48, 48> lawCellCurvature(const LawCell& cell, const WallMotion& motion);

}  // namespace viscera
