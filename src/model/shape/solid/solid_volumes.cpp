// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_volumes.h"

#include <algorithm>
#include <cmath>

#include "model/shape/solid/joined_parts.h"
#include "model/shape/solid/solid_grid.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Returns what to try where open sheets may enclose a body together; empty for a flat mesh.
std::string enclosedHint(const TriangleMesh& mesh) {
  constexpr float kFlat = 1e-3f;  // share of the largest extent
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : mesh.positions_m) box.extend(p);
  const Vector3f size = box.sizes();
  if (size.minCoeff() <= kFlat * size.maxCoeff()) return "";
  return "; if its sheets together enclose one, set fill: enclosed";
}

}  // namespace

std::vector<Volume> closeParts(const TriangleMesh& mesh, VoxelReport& report) {
  std::vector<Volume> volumes;
  for (ClosedSurface& surface : closeSurfaces(mesh)) {
    Shell& shell = surface.shell;
    if (shell.isOpenSheet()) continue;
    report.mesh_volume_m3 += std::abs(shell.volume_m3);
    report.holes_closed += shell.holes_closed;
    volumes.push_back({std::move(shell), surface.part});
    if (!surface.is_joined) continue;
    for (const uint32_t t : surface.triangles) volumes.back().triangle_parts.push_back(mesh.parts[t]);
  }
  std::stable_sort(volumes.begin(), volumes.end(), [](const Volume& a, const Volume& b) {
    return std::abs(a.shell.volume_m3) < std::abs(b.shell.volume_m3);
  });
  if (volumes.empty())
    throw MeshError("the mesh encloses no volume: it is an open sheet, not the surface of a body" + enclosedHint(mesh));
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

void countDropped(const TriangleMesh& mesh, const Solid& solid, VoxelReport& report) {
  std::vector<bool> seen(solid.part_names.size() + 1, false);
  for (const uint16_t label : solid.labels) seen[label] = true;
  std::vector<double> areas_m2 = partAreas(mesh);
  areas_m2.resize(solid.part_names.size(), 0);  // the solid may have one part more than the mesh
  double dropped_m2 = 0, all_m2 = 0;
  for (size_t part = 0; part < solid.part_names.size(); ++part) {
    all_m2 += areas_m2[part];
    if (seen[part + 1]) continue;
    report.dropped_names.push_back(solid.part_names[part]);
    dropped_m2 += areas_m2[part];
  }
  report.parts_dropped = static_cast<int>(report.dropped_names.size());
  report.dropped_surface = all_m2 > 0 ? dropped_m2 / all_m2 : 0;
}

void refuseEmpty(const std::vector<Volume>& volumes, const TriangleMesh& mesh, double spacing_m,
                 const std::function<bool(double)>& fills) {
  try {
    requireFinerSpacing(spacing_m, fills);
  } catch (const LatticeError& error) {
    throw LatticeError(error.what() + farPartNote(namedShells(volumes, mesh)));
  }
  throw MeshError("the mesh encloses no volume: its surfaces coincide");
}

}  // namespace viscera
