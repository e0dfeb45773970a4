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

/// Closed surface with an inside: of one part, or of several joined parts.
struct Volume {
  Shell shell;
  uint16_t part;  ///< of several parts, the largest
  std::vector<uint16_t> triangle_parts =
      {};  ///< [own triangles of the shell] part of each if there are several parts; else empty
};

/// Closes every surface (closeSurfaces()); those that enclose nothing are left out. Smallest first.
/// @throws MeshError  none encloses anything
std::vector<Volume> closeParts(const TriangleMesh& mesh, VoxelReport& report);

std::vector<NamedShell> namedShells(const std::vector<Volume>& volumes, const TriangleMesh& mesh);
Eigen::AlignedBox3d boundsOf(const std::vector<Volume>& volumes);

/// Returns the first and one past the last cell of a row with centres within an interval.
std::pair<int, int> centresWithin(const InsideStretch& stretch, int cells);
/// Labels the cells with a centre inside that belong to no other volume.
void fillCentres(const Volume& volume, Solid& solid);

/// Gives the cells of volumes of several parts to the part with the nearest surface, found by a flood from the
/// surfaces.
void nameJoinedParts(const std::vector<Volume>& volumes, Solid& solid);

/// Counts parts of the mesh without a cell.
void countDropped(const TriangleMesh& mesh, const Solid& solid, VoxelReport& report);

/// Reports a spacing at which a mesh filled no cell.
/// @param fills  (spacing_m) -> whether any cell is filled at this spacing
/// @throws LatticeError  a spacing that would work; MeshError  there is none
void refuseEmpty(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m,
                 const std::function<bool(double)>& fills);

}  // namespace viscera
