// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "model/shape/solid/solid_gaps.h"
#include "model/shape/solid/solid_lines.h"
#include "model/shape/solid/solid_shell.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// A part that has an inside.
struct Volume {
  Shell shell;
  uint16_t part;
};

/// Closes every part; those that enclose nothing are left out. Smallest first.
/// @throws MeshError  none encloses anything
std::vector<Volume> closeParts(const TriangleMesh& mesh, VoxelReport& report);

std::vector<NamedShell> namedShells(const std::vector<Volume>& volumes, const TriangleMesh& mesh);
Eigen::AlignedBox3d boundsOf(const std::vector<Volume>& volumes);

/// First and one past the last cell of a row whose centres lie within a stretch.
std::pair<int, int> centresWithin(const InsideStretch& stretch, int cells);
/// Labels the cells whose centre is inside and that no other volume has.
void fillCentres(const Volume& volume, Solid& solid);

/// Looks for parts without a cell.
void countDropped(const Solid& solid, VoxelReport& report);

/// For a spacing at which a mesh filled no cell.
/// @param fills  (spacing_m) -> whether it fills any at that one
/// @throws LatticeError  a spacing that would do; MeshError  there is none
void refuseEmpty(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m,
                 const std::function<bool(double)>& fills);

}  // namespace viscera
