// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/shape/solid.h"

namespace viscera {

// Moments of pieces of one cell. Places are in cells, from the middle of the cell.

/// Cells with less tissue are empty, their neighbours have it: they would add nodes but, as calculated, no accuracy.
constexpr double kLeastShare = 1e-2;
/// Cells with less than this missing are full: rounding of single-precision meshes is some 1e-4 of a cell.
constexpr double kLeastGap = 1e-3;

/// Of a cell without tissue.
CellFill noFill();
/// Adds `times` a piece to a sum.
void add(CellFill& sum, const CellFill& piece, double times = 1);
CellFill boxFill(const Vector3d& low, const Vector3d& high);
/// Of a tetrahedron, however it is oriented.
CellFill tetFill(const std::array<Vector3d, 4>& corners);
/// Whether some set of points within the cell may have these moments: sums of approximations need not.
bool isPossible(const CellFill& fill);

/// Gives each sliver of tissue to the labelled cell across the face that it is nearest to, as if that one went on:
/// volume, middle and inertia of the body stay. Slivers without such a neighbour are lost.
/// @param slivers  of cells that have no label
void giveSlivers(const std::vector<PartialCell>& slivers, Solid& solid);

}  // namespace viscera
