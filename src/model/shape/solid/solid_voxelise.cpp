// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The fill rule: which cells of the grid are tissue. Meshes are dirty, so the rule is defined for any set of triangles.
//
//  1. Parts are filled one by one; the solid is their union. Parts with open borders that meet are one part
//     (joined_parts.h).
//  2. Within a part, triangles that share an edge are first turned to agree (the majority of a connected piece wins).
//     Then every boundary loop is closed by a fan about its middle. A part with caps of more than 0.6 of its own area
//     (a plane, a sheet, a shallow bowl) is an open sheet: it has no inside and is left out.
//  3. A point is inside a part where the part's winding number is not zero. Hence overlapping pieces of a part merge,
//     and a part that is inside out is filled too. An inner surface that faces the opposite direction to the one around
//     it bounds a cavity that stays empty. Chambers that open to the outside are outside.
//  4. A cell is filled if its centre is inside a part.
//  5. Thin walls: a line through the centres of a row of cells (along x, y or z) may run inside a part between two of
//     these centres. If it meets both faces of the wall within about 55 degrees of their normals, the cell that
//     contains the middle of the interval is filled too. A wall thinner than a cell thus becomes one cell thick,
//     without holes.
//  6. A cell claimed by several parts belongs to the part with the smallest volume. Details such as a papillary muscle
//     are then not absorbed by the wall that they grow from. A thin-wall cell never takes a cell filled by rule 4.
//  7. Crumbs: pieces that touch no other piece, not even at a corner, and have less than a thousandth of the cells of
//     the largest piece are emptied. They would only fall.
//
// Rule 3 is decided exactly (solid_lines.cpp). OpenVDB's meshToVolume is not used here: it finds the inside by flooding
// from outside, so that closed cavities are filled and a hole wider than a cell empties the body.
#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "model/shape/solid/solid_crumbs.h"
#include "model/shape/solid/solid_grid.h"
#include "model/shape/solid/solid_volumes.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/solid.h"

namespace viscera {
namespace {

constexpr double kThinnest = 1e-3;  ///< in cells: shorter intervals come from the rounding of two coincident faces

/// Fills thin walls along an axis. Returns the number of cells filled.
int fillThinWalls(const Volume& volume, int axis, Solid& solid) {
  int filled = 0;
  for (const InsideStretch& stretch : insideStretches(volume.shell, solid, axis)) {
    const auto [first, last] = centresWithin(stretch, solid.cells[axis]);
    if (first < last || !stretch.head_on || stretch.to - stretch.from < kThinnest) continue;
    Vector3i cell;
    cell[axis] = static_cast<int>(std::floor(0.5 * (stretch.from + stretch.to)));
    cell[(axis + 1) % 3] = stretch.column_u;
    cell[(axis + 2) % 3] = stretch.column_v;
    cell[axis] = std::clamp(cell[axis], 0, solid.cells[axis] - 1);
    uint16_t& label = solid.labels[solid.index(cell.x(), cell.y(), cell.z())];
    if (label != 0) continue;
    label = volume.part + 1;
    ++filled;
  }
  return filled;
}

/// Returns the filled grid; all labels are 0 where the spacing is too large for the body.
Solid fill(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m, VoxelReport& report,
           const Progress& progress) {
  requireParted(namedShells(volumes, mesh), spacing_m);
  const Eigen::AlignedBox3d bounds = boundsOf(volumes);
  Solid solid = emptySolid(bounds.min(), bounds.max(), spacing_m, mesh.part_names);
  const double steps = 2.0 * static_cast<double>(volumes.size());
  double done = 0;
  const auto advance = [&] {
    if (progress) progress("voxelise", ++done / steps);
  };
  for (const Volume& volume : volumes) {
    fillCentres(volume, solid);
    advance();
  }
  for (const Volume& volume : volumes) {
    for (int axis = 0; axis < 3; ++axis) report.thin_cells += fillThinWalls(volume, axis, solid);
    advance();
  }
  return solid;
}

}  // namespace

std::string VoxelReport::text() const {
  constexpr double kCm3 = 1e6;
  TextOut out;
  out << "mesh volume " << mesh_volume_m3 * kCm3 << " cm3, filled " << filled_volume_m3 * kCm3 << " cm3; "
      << holes_closed << " holes closed, " << thin_cells << " thin-wall cells, " << crumbs_removed
      << " small pieces removed, " << parts_dropped << " parts dropped";
  for (size_t i = 0; i < dropped_names.size(); ++i) out << (i == 0 ? ": " : ", ") << dropped_names[i];
  constexpr double kMost = 0.5;
  if (dropped_surface > kMost)
    out << "; parts with " << std::lround(100 * dropped_surface)
        << " % of the surface were dropped; if all parts together "
        << "enclose the body, set fill: enclosed";
  return out.str();
}

Solid voxelise(const TriangleMesh& mesh, double spacing_m, VoxelReport* report, const Progress& progress) {
  requireSpacing(spacing_m);
  VoxelReport found;
  const std::vector<Volume> volumes = closeParts(mesh, found);
  Solid solid = fill(volumes, mesh, spacing_m, found, progress);
  if (solid.filledCells() == 0) {
    VoxelReport ignored;
    refuseEmpty(volumes, mesh, spacing_m,
                [&](double h) { return fill(volumes, mesh, h, ignored, {}).filledCells() > 0; });
  }
  nameJoinedParts(volumes, solid);
  found.crumbs_removed = removeCrumbs(solid, kCrumb);
  found.filled_volume_m3 = solid.volumeM3();
  countDropped(mesh, solid, found);
  if (report != nullptr) *report = found;
  return solid;
}

}  // namespace viscera
