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

/// A surface that has an inside: of a part, or of several that are joined.
struct Volume {
  Shell shell;
  uint16_t part;  ///< of several, the largest
  std::vector<uint16_t> triangle_parts =
      {};  ///< [own triangles of the shell] where they are of several parts; else empty
};

/// Closes every surface (closeSurfaces()); those that enclose nothing are left out. Smallest first.
/// @throws MeshError  none encloses anything
std::vector<Volume> closeParts(const TriangleMesh& mesh, VoxelReport& report);

std::vector<NamedShell> namedShells(const std::vector<Volume>& volumes, const TriangleMesh& mesh);
Eigen::AlignedBox3d boundsOf(const std::vector<Volume>& volumes);

/// First and one past the last cell of a row whose centres lie within a stretch.
std::pair<int, int> centresWithin(const InsideStretch& stretch, int cells);
/// Labels the cells whose centre is inside and that no other volume has.
void fillCentres(const Volume& volume, Solid& solid);

/// Gives the cells of volumes of several parts to the part whose surface is nearest, as a flood from it finds it.
void nameJoinedParts(const std::vector<Volume>& volumes, Solid& solid);

/// Looks for parts of the mesh without a cell.
void countDropped(const TriangleMesh& mesh, const Solid& solid, VoxelReport& report);

/// For a spacing at which a mesh filled no cell.
/// @param fills  (spacing_m) -> whether it fills any at that one
/// @throws LatticeError  a spacing that would do; MeshError  there is none
void refuseEmpty(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m,
                 const std::function<bool(double)>& fills);

}  // namespace viscera
