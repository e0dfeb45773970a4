// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/enclosed/enclosed_solid.h"

#include <algorithm>
#include <cmath>

#include "model/shape/enclosed/enclosed_surface.h"
#include "model/shape/solid/solid_volumes.h"
#include "model/shape/solid/triangle_samples.h"

namespace viscera {
namespace {

constexpr double kEnclosedStep = 0.25;  ///< in cells: step of the grid on which the inside is found

/// Assignment of the remaining region's cells to parts.
class Regions {
 public:
  Regions(Solid& solid, uint16_t rest) : solid_(solid), rest_(rest) {}

  void take(const Vector3i& cell, uint16_t part) {
    if (solid_.label(cell.x(), cell.y(), cell.z()) != rest_) return;
    solid_.labels[solid_.index(cell.x(), cell.y(), cell.z())] = part + 1;
  }

  void takeInside(const Volume& volume) {
    for (const InsideStretch& stretch : insideStretches(volume.shell, solid_, 0)) {
      const auto [first, last] = centresWithin(stretch, solid_.cells.x());
      for (int x = first; x < last; ++x) take({x, stretch.column_u, stretch.column_v}, volume.part);
    }
  }

  void takeAlong(const TriangleMesh& mesh, uint32_t triangle) {
    std::array<Vector3d, 3> p;
    for (int c = 0; c < 3; ++c) {
      p[c] = (mesh.positions_m[mesh.triangles[triangle][c]].cast<double>() - solid_.origin_m) / solid_.spacing_m;
    }
    forEachSample(p, [&](const Vector3d& at) { take(at.array().floor().cast<int>(), mesh.parts[triangle]); });
  }

 private:
  Solid& solid_;
  const uint16_t rest_;
};

void nameRegions(const TriangleMesh& mesh, uint16_t rest, Solid& solid) {
  Regions regions(solid, rest);
  std::vector<Volume> closed;
  std::vector<uint32_t> open;
  const auto triangles = trianglesByPart(mesh);
  for (size_t part = 0; part < triangles.size(); ++part) {
    Shell shell = closePart(mesh, triangles[part]);
    if (shell.cap_area_m2 == 0 && shell.volume_m3 != 0) {
      closed.push_back({std::move(shell), static_cast<uint16_t>(part)});
    } else {
      open.insert(open.end(), triangles[part].begin(), triangles[part].end());
    }
  }
  std::stable_sort(closed.begin(), closed.end(), [](const Volume& a, const Volume& b) {
    return std::abs(a.shell.volume_m3) < std::abs(b.shell.volume_m3);
  });
  for (const uint32_t t : open) regions.takeAlong(mesh, t);
  for (const Volume& volume : closed) regions.takeInside(volume);
}

}  // namespace

Solid voxeliseEnclosed(const TriangleMesh& mesh, double spacing_m, double gap_m, bool moments, const NodePlanes& planes,
                       std::string& note, const Progress& progress) {
  EnclosedSurface enclosed = enclosedSurface(mesh, kEnclosedStep * spacing_m, gap_m);
  const auto part = static_cast<uint16_t>(mesh.part_names.size());
  std::fill(enclosed.mesh.parts.begin(), enclosed.mesh.parts.end(), part);
  const std::string own_name = enclosed.mesh.part_names[0];
  enclosed.mesh.part_names = mesh.part_names;
  enclosed.mesh.part_names.push_back(own_name);
  VoxelReport report;
  Solid solid = moments ? voxeliseByMoments(enclosed.mesh, spacing_m, planes, &report, progress)
                        : voxelise(enclosed.mesh, spacing_m, &report, progress);
  nameRegions(mesh, part + 1, solid);
  report.dropped_names.clear();
  countDropped(mesh, solid, report);
  report.dropped_surface = 0;  // it is enclosed anyway
  note = enclosed.text() + "; " + report.text();
  return solid;
}

}  // namespace viscera
