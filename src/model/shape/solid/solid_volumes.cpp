// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_volumes.h"

#include <algorithm>
#include <cmath>

#include "model/shape/solid/solid_grid.h"
#include "viscera/math/error.h"

namespace viscera {

std::vector<Volume> closeParts(const TriangleMesh& mesh, VoxelReport& report) {
  std::vector<Volume> volumes;
  const std::vector<std::vector<uint32_t>> triangles = trianglesByPart(mesh);
  for (size_t part = 0; part < mesh.part_names.size(); ++part) {
    Shell shell = closePart(mesh, triangles[part]);
    if (shell.triangles.empty() || shell.isOpenSheet()) continue;
    report.mesh_volume_m3 += std::abs(shell.volume_m3);
    report.holes_closed += shell.holes_closed;
    volumes.push_back({std::move(shell), static_cast<uint16_t>(part)});
  }
  std::stable_sort(volumes.begin(), volumes.end(), [](const Volume& a, const Volume& b) {
    return std::abs(a.shell.volume_m3) < std::abs(b.shell.volume_m3);
  });
  if (volumes.empty()) throw MeshError("the mesh encloses no volume: it is an open sheet, not the surface of a body");
  return volumes;
}

std::vector<NamedShell> namedShells(const std::vector<Volume>& volumes, const TriangleMesh& mesh) {
  std::vector<NamedShell> out;
  for (const Volume& volume : volumes) out.push_back({&volume.shell, mesh.part_names[volume.part]});
  return out;
}

Eigen::AlignedBox3d boundsOf(const std::vector<Volume>& volumes) {
  Eigen::AlignedBox3d bounds;
  for (const Volume& volume : volumes) bounds.extend(volume.shell.min()).extend(volume.shell.max());
  return bounds;
}

std::pair<int, int> centresWithin(const InsideStretch& stretch, int cells) {
  const int first = static_cast<int>(std::ceil(stretch.from - 0.5));
  const int last = static_cast<int>(std::ceil(stretch.to - 0.5));
  return {std::clamp(first, 0, cells), std::clamp(last, 0, cells)};
}

void fillCentres(const Volume& volume, Solid& solid) {
  for (const InsideStretch& stretch : insideStretches(volume.shell, solid, 0)) {
    const auto [first, last] = centresWithin(stretch, solid.cells.x());
    for (int x = first; x < last; ++x) {
      uint16_t& label = solid.labels[solid.index(x, stretch.column_u, stretch.column_v)];
      if (label == 0) label = volume.part + 1;
    }
  }
}

void countDropped(const Solid& solid, VoxelReport& report) {
  std::vector<bool> seen(solid.part_names.size() + 1, false);
  for (const uint16_t label : solid.labels) seen[label] = true;
  for (size_t part = 0; part < solid.part_names.size(); ++part) {
    if (!seen[part + 1]) report.dropped_names.push_back(solid.part_names[part]);
  }
  report.parts_dropped = static_cast<int>(report.dropped_names.size());
}

void refuseEmpty(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m,
                 const std::function<bool(double)>& fills) {
  try {
    requireFinerSpacing(spacing_m, fills);
  } catch (const LatticeError& error) {
    throw LatticeError(error.what() + farPartNote(namedShells(volumes, mesh)));
  }
  throw MeshError("the mesh encloses no volume: its surfaces lie on each other");
}

}  // namespace viscera
