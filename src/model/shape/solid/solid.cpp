// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/solid.h"

#include <algorithm>

#include "model/shape/solid/solid_grid.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

void fillLayer(const DistanceField& field, int z, Solid& solid) {
  for (int y = 0; y < solid.cells.y(); ++y) {
    for (int x = 0; x < solid.cells.x(); ++x) {
      const LabelledDistance at = field(solid.origin_m + solid.spacing_m * Vector3d(x + 0.5, y + 0.5, z + 0.5));
      if (at.distance_m < 0) solid.labels[solid.index(x, y, z)] = at.part + 1;
    }
  }
}

}  // namespace

uint16_t Solid::label(int x, int y, int z) const {
  if (x < 0 || y < 0 || z < 0 || x >= cells.x() || y >= cells.y() || z >= cells.z()) return 0;
  return labels[index(x, y, z)];
}

size_t Solid::filledCells() const {
  return labels.size() - static_cast<size_t>(std::count(labels.begin(), labels.end(), uint16_t{0}));
}

double Solid::volumeM3() const {
  double cells = static_cast<double>(filledCells());
  for (const PartialCell& p : partial) cells -= 1 - p.fill.share;
  return cells * spacing_m * spacing_m * spacing_m;
}

Solid voxelise(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
               const Vector3d& max_m, double spacing_m, const Progress& progress) {
  const auto fill = [&](double h, const Progress& reported) {
    Solid solid = emptySolid(min_m, max_m, h, part_names);
    for (int z = 0; z < solid.cells.z(); ++z) {
      fillLayer(field, z, solid);
      if (reported) reported("voxelise", (z + 1.0) / solid.cells.z());
    }
    return solid;
  };
  Solid solid = fill(spacing_m, progress);
  if (solid.filledCells() > 0) return solid;
  requireFinerSpacing(spacing_m, [&](double h) { return fill(h, {}).filledCells() > 0; });
  throw LatticeError("the body is empty: its distance field is not negative anywhere within its bounds");
}

Solid boxSolid(const Vector3d& min_m, const Vector3d& size_m, double spacing_m) {
  requireSpacing(spacing_m);
  const Eigen::Array3d cells = (size_m.array() / spacing_m).round().max(1.0);
  requireGridMemory(cells, spacing_m);
  Solid solid;
  solid.spacing_m = spacing_m;
  solid.origin_m = min_m;
  solid.cells = cells.cast<int>();
  solid.part_names = {"box"};
  solid.labels.assign(static_cast<size_t>(cells.prod()), 1);
  return solid;
}

}  // namespace viscera
