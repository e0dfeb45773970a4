// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/shape/solid.h"

namespace viscera {

// Moments of pieces of one cell. Positions are in cells, relative to the cell's centre.

/// Cells with less tissue are emptied and their neighbours get it: as calculated, they would add nodes but no accuracy.
constexpr double kLeastShare = 1e-2;
/// Cells with less than this missing are full: rounding of single-precision meshes is about 1e-4 of a cell.
constexpr double kLeastGap = 1e-3;

/// Returns the moments of a cell without tissue.
CellFill noFill();
/// Adds a piece, multiplied by `times`, to a sum.
void add(CellFill& sum, const CellFill& piece, double times = 1);
CellFill boxFill(const Vector3d& low, const Vector3d& high);
/// Returns the moments of a tetrahedron of either orientation.
CellFill tetFill(const std::array<Vector3d, 4>& corners);
/// Returns whether some set of points within the cell can have these moments: sums of approximations need not.
bool isPossible(const CellFill& fill);

/// Gives each sliver of tissue to the labelled cell across its nearest face, as if that cell extended into it. Volume,
/// centre and inertia of the body are kept. Slivers without such a neighbour are lost.
/// @param slivers  of cells that have no label
void giveSlivers(const std::vector<PartialCell>& slivers, Solid& solid);

}  // namespace viscera
