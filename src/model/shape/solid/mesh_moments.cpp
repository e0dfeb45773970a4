// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/node_depths.h"
#include "model/shape/solid/solid_crumbs.h"
#include "model/shape/solid/solid_grid.h"
#include "model/shape/solid/solid_moments.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Returns the filled grid; all labels are 0 where the spacing is too large for the body.
Solid fill(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m, const NodePlanes& planes,
           const Progress& progress) {
  requireParted(namedShells(volumes, mesh), spacing_m);
  const Eigen::AlignedBox3d bounds = boundsOf(volumes);
  Solid solid = emptySolid(bounds.min(), bounds.max(), spacing_m, mesh.part_names, planes);
  fillByMoments(volumes, solid, progress);
  return solid;
}

}  // namespace

Solid voxeliseByMoments(const TriangleMesh& mesh, double spacing_m, const NodePlanes& planes, VoxelReport* report,
                        const Progress& progress) {
  requireSpacing(spacing_m);
  VoxelReport found;
  const std::vector<Volume> volumes = closeParts(mesh, found);
  Solid solid = fill(volumes, mesh, spacing_m, planes, progress);
  if (solid.filledCells() == 0) {
    refuseEmpty(volumes, mesh, spacing_m,
                [&](double h) { return fill(volumes, mesh, h, planes, {}).filledCells() > 0; });
  }
  nameJoinedParts(volumes, solid);
  found.crumbs_removed = removeCrumbs(solid, kCrumb);
  if (!solid.partial.empty()) measureDepths(volumes, solid);
  found.filled_volume_m3 = solid.volumeM3();
  countDropped(mesh, solid, found);
  if (report != nullptr) *report = found;
  return solid;
}

}  // namespace viscera
