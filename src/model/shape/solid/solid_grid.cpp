// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_grid.h"

#include <cmath>

#include "math/number_text.h"
#include "model/scene/host_memory.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Memory per cell: a dense label, its share of scratch, and the nodes, surface mesh and solver state of a grid that is
/// one third full.
constexpr double kBytesPerCell = 48;
/// Largest number of cells along an axis that lattice coordinates and the exact arithmetic of voxelisation can hold.
constexpr double kMostCellsPerAxis = 1 << 20;
/// Fraction of a cell by which a box may extend beyond its grid: rounding of single-precision meshes.
constexpr double kOverhang = 1e-4;

}  // namespace

void requireSpacing(double spacing_m) {
  if (std::isfinite(spacing_m) && spacing_m > 0) return;
  TextOut out;
  out << "spacing_m must be a finite number > 0, not " << spacing_m;
  throw LatticeError(out.str());
}

void requireSpacingWithin(const Vector3d& size_m, double spacing_m) {
  requireSpacing(spacing_m);
  if (spacing_m <= size_m.maxCoeff()) return;
  TextOut out;
  out << "spacing_m " << spacing_m << " is larger than the whole body, " << size_m.x() << " x " << size_m.y() << " x "
      << size_m.z() << " m; spacing_m must be at most " << size_m.maxCoeff();
  throw LatticeError(out.str());
}

void requireFinerSpacing(double spacing_m, const std::function<bool(double)>& fills) {
  constexpr int kHalvings = 6;
  for (int i = 1; i <= kHalvings; ++i) {
    const double finer_m = spacing_m / (1 << i);
    if (!fills(finer_m)) continue;
    TextOut out;
    out << "spacing_m " << spacing_m << " is too large: no cell is inside the body; spacing_m must be at most "
        << finer_m;
    throw LatticeError(out.str());
  }
}

void requireGridMemory(const Eigen::Array3d& cells, double spacing_m) {
  const double needed = kBytesPerCell * cells.prod(), available = availableBytes();
  const double memory_factor = std::cbrt(needed / available), axis_factor = cells.maxCoeff() / kMostCellsPerAxis;
  const double factor = std::max(memory_factor, axis_factor);
  if (factor <= 1) return;
  TextOut out;
  out << "spacing_m " << spacing_m << " gives a grid of " << cells.x() << " x " << cells.y() << " x " << cells.z()
      << " cells, about " << needed / (1 << 30) << " GiB, but this machine has " << available / (1 << 30)
      << " GiB free; spacing_m >= " << spacing_m * factor * 1.05 << " would fit";
  throw LatticeError(out.str());
}

Solid emptySolid(const Vector3d& min_m, const Vector3d& max_m, double spacing_m,
                 const std::vector<std::string>& part_names, const NodePlanes& planes) {
  const Vector3d size = max_m - min_m;
  requireSpacingWithin(size, spacing_m);
  Eigen::Array3d cells = (size.array() / spacing_m - kOverhang).ceil().max(1.0);
  Vector3d origin_m = 0.5 * (min_m + max_m) - 0.5 * spacing_m * cells.matrix();
  for (int axis = 0; axis < 3; ++axis) {
    if (!planes[axis]) continue;
    const double first = std::floor((min_m[axis] - *planes[axis]) / spacing_m + kOverhang);
    const double end = std::ceil((max_m[axis] - *planes[axis]) / spacing_m - kOverhang);
    cells[axis] = std::max(1.0, end - first);
    origin_m[axis] = *planes[axis] + first * spacing_m;
  }
  requireGridMemory(cells, spacing_m);
  Solid solid;
  solid.spacing_m = spacing_m;
  solid.cells = cells.cast<int>();
  solid.origin_m = origin_m;
  solid.part_names = part_names;
  solid.labels.assign(static_cast<size_t>(cells.prod()), 0);
  return solid;
}

}  // namespace viscera
