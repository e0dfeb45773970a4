// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_anchor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {

namespace {

// All coordinates here are in cells: point (1.5, 0, 0) is the middle of an edge of cell (1, 0, 0).

/// Distance from a cell up to which a vertex still moves with that cell's tissue, by extrapolation.
constexpr double kBeside = 0.5;

Vector3i unit(int axis) {
  return Vector3i::Unit(axis);
}

/// Returns the point of a face that is nearest to a point.
Vector3d closestOnFace(const Vector3d& point, const Vector3i& cell, int axis, int side) {
  Vector3d low = cell.cast<double>();
  Vector3d high = low + Vector3d::Ones();
  low[axis] = high[axis] = cell[axis] + side;
  return point.cwiseMax(low).cwiseMin(high);
}

/// Returns the triangle of a face that contains a point of that face. Faces are split along the diagonal between nodes
/// with an even sum of coordinates, so that the pattern has no preferred direction.
Anchor anchorOnFace(const Vector3d& position, const Vector3i& cell, int axis, int side) {
  const Vector3i low = cell + side * unit(axis);
  const Vector3i u = unit((axis + 1) % 3), v = unit((axis + 2) % 3);
  const std::array<Vector3i, 4> corners = {low, low + u, low + u + v, low + v};  // counter-clockwise along +axis
  const bool low_is_even = (low.sum() & 1) == 0;
  Anchor anchor;
  for (int half = 0; half < 2; ++half) {
    const int right_angle = (low_is_even ? 1 : 0) + 2 * half;  // a node with an odd sum
    const Vector3i at = corners[right_angle];
    Vector3i next = corners[(right_angle + 1) % 4], previous = corners[(right_angle + 3) % 4];
    if (side == 0) std::swap(next, previous);
    const Vector3d from_angle = position - at.cast<double>();
    anchor.nodes = {at, next, previous};
    anchor.weight1 = std::clamp(from_angle.dot((next - at).cast<double>()), 0.0, 1.0);
    anchor.weight2 = std::clamp(from_angle.dot((previous - at).cast<double>()), 0.0, 1.0);
    if (anchor.weight1 + anchor.weight2 <= 1) break;
  }
  return anchor;
}

/// Returns the number of cells between a cell and the grid, along the axis where it is farthest outside; 0 inside.
int cellsOutside(const Vector3i& cell, const Vector3i& cells) {
  return (-cell).cwiseMax(cell - cells + Vector3i::Ones()).cwiseMax(Vector3i::Zero()).maxCoeff();
}

}  // namespace

template <class Visit>
void AnchorFinder::forEachCellOfShell(const Vector3i& center, int radius, Visit visit) const {
  const Vector3i low = (center.array() - radius).max(0);
  const Vector3i high = (center.array() + radius).min(solid_.cells.array() - 1);
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y) {
      const bool whole_row = std::abs(z - center.z()) == radius || std::abs(y - center.y()) == radius;
      for (int x = low.x(); x <= high.x(); ++x) {
        if (whole_row || std::abs(x - center.x()) == radius) visit(Vector3i(x, y, z));
      }
    }
}

AnchorFinder::Face AnchorFinder::nearestBoundary(const Vector3d& point, const Vector3d& outward) const {
  const Vector3i home = point.array().floor().cast<int>();
  Face best;
  double best_cost = std::numeric_limits<double>::infinity();
  const auto visit = [&](const Vector3i& cell) {
    if (!filled(cell)) return;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, side = face % 2;
      if (filled(cell + (2 * side - 1) * unit(axis))) continue;
      const double distance2 = (point - closestOnFace(point, cell, axis, side)).squaredNorm();
      const double away = std::max(0.0, side ? -outward[axis] : outward[axis]);
      if (distance2 + away * away < best_cost) {
        best_cost = distance2 + away * away;
        best = {cell, axis, side, distance2};
      }
    }
  };
  // Cells of shell r are at least r - 1 away, so the search ends once the best is nearer.
  for (int radius = cellsOutside(home, solid_.cells); best_cost > static_cast<double>(radius - 1) * (radius - 1);
       ++radius) {
    forEachCellOfShell(home, radius, visit);
  }
  return best;
}

AnchorFinder::Face AnchorFinder::nearestFaceOf(const Vector3i& cell, const Vector3d& point) const {
  const Vector3d in_cell = point - cell.cast<double>();
  Face nearest;
  nearest.distance2 = std::numeric_limits<double>::infinity();
  for (int f = 0; f < 6; ++f) {
    const double distance = in_cell[f / 2] - f % 2;
    if (distance * distance < nearest.distance2) nearest = {cell, f / 2, f % 2, distance * distance};
  }
  return nearest;
}

Anchor atNearestNode(const Anchor& anchor) {
  Anchor out = anchor;
  out.weight1 = out.weight2 = 0;
  const auto& [angle, next, previous] = anchor.nodes;
  const Vector3i opposite = next + previous - angle;
  if (anchor.weight1 > 0.5) out.nodes = {next, opposite, angle};
  if (anchor.weight2 > 0.5) out.nodes = {previous, angle, opposite};
  return out;
}

Anchor AnchorFinder::find(const Vector3d& point_m, const Vector3d& outward, bool in_cells) const {
  const Vector3d point = (point_m - solid_.origin_m) / solid_.spacing_m;
  Face face = nearestBoundary(point, outward);
  const Vector3i home = point.array().floor().cast<int>();
  const bool deep = face.distance2 > 1 && filled(home);
  const bool moves_with_cell =
      in_cells && !solid_.partial.empty() && (filled(home) || face.distance2 <= kBeside * kBeside);
  if (deep || moves_with_cell) face = nearestFaceOf(filled(home) ? home : face.cell, point);
  Anchor anchor = anchorOnFace(closestOnFace(point, face.cell, face.axis, face.side), face.cell, face.axis, face.side);
  anchor.deep = deep;
  if (moves_with_cell) anchor.cell = face.cell;
  return anchor;
}

}  // namespace viscera
