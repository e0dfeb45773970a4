// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the divergence theorem along x. A piece of the surface adds everything beyond it, with the sign of its
// projection on the y-z plane: the rest of its own cell, and the column of its shadow in every cell behind it.
// Triangles are clipped to cells; the integrand over a piece is a polynomial of degree 3 at most.
#include "model/shape/solid/winding_sums.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "model/shape/solid/cell_fill.h"

namespace viscera {
namespace {

using Polygon = std::vector<Vector3d>;  ///< flat and convex, in cells

/// Returns the part of a polygon on one side of a plane across an axis.
/// @param sign  1: where the coordinate is larger, -1: where it is smaller
Polygon clipped(const Polygon& polygon, int axis, double plane, double sign) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Vector3d crossing = a + da / (da - db) * (b - a);
      crossing[axis] = plane;
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// Calls visit(polygon, cell) for the pieces of a polygon in the cells of a grid, from `axis` on.
template <class Visit>
void cut(const Polygon& polygon, const Vector3i& cells, int axis, Vector3i cell, Visit& visit) {
  if (axis == 3) return visit(polygon, cell);
  double low = polygon[0][axis], high = low;
  for (const Vector3d& p : polygon) {
    low = std::min(low, p[axis]);
    high = std::max(high, p[axis]);
  }
  const int first = std::clamp(static_cast<int>(std::floor(low)), 0, cells[axis] - 1);
  const int last = std::clamp(static_cast<int>(std::ceil(high)) - 1, first, cells[axis] - 1);
  for (int i = first; i <= last; ++i) {
    Polygon piece = i == first ? polygon : clipped(polygon, axis, i, 1);
    if (i < last) piece = clipped(piece, axis, i + 1, -1);
    if (piece.size() < 3) continue;
    cell[axis] = i;
    cut(piece, cells, axis + 1, cell, visit);
  }
}

/// Integrals of 1, y, z, y^2, y z, z^2 over the shadow of a piece, for a whole cell.
using Column = Eigen::Matrix<double, 6, 1>;

CellFill fillOf(const Column& c) {
  CellFill fill = noFill();
  fill.share = c[0];
  fill.first = {0, c[1], c[2]};
  fill.second << c[0] / 12, 0, 0, 0, c[3], c[4], 0, c[4], c[5];
  return fill;
}

/// Pieces of the surface in one cell.
struct CellPieces {
  CellFill beyond = noFill();      ///< moments beyond the surface in the cell itself
  Column column = Column::Zero();  ///< integrals in each cell behind it along x

  /// @param p  point of the surface, relative to the cell's centre   @param weight  projected area that it represents
  void addPoint(const Vector3d& p, double weight) {
    const double x = p.x(), y = p.y(), z = p.z();
    const double rest = weight * (0.5 - x), rest_x = weight * (0.25 - x * x) / 2;
    const double rest_xx = weight * (0.125 - x * x * x) / 3;
    CellFill f = noFill();
    f.share = rest;
    f.first = {rest_x, rest * y, rest * z};
    f.second << rest_xx, rest_x * y, rest_x * z, rest_x * y, rest * y * y, rest * y * z, rest_x * z, rest * y * z,
        rest * z * z;
    add(beyond, f);
    Column c;
    c << 1, y, z, y * y, y * z, z * z;
    column += weight * c;
  }

  void addTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const Vector3d ab = b - a, ac = c - a;
    const double weight = -0.5 * (ab.y() * ac.z() - ab.z() * ac.y());
    if (weight == 0) return;  // edge-on
    const Vector3d sum = a + b + c;
    addPoint(sum / 3, -27.0 / 48 * weight);  // Strang's rule of degree 3
    for (const Vector3d& corner : {a, b, c}) addPoint(0.2 * sum + 0.4 * corner, 25.0 / 48 * weight);
  }
};

}  // namespace

std::vector<SurfaceCell> windingSums(const Shell& shell, const Solid& grid) {
  std::unordered_map<size_t, CellPieces> pieces;
  auto visit = [&](const Polygon& polygon, const Vector3i& cell) {
    CellPieces& here = pieces[grid.index(cell.x(), cell.y(), cell.z())];
    const Vector3d middle = cell.cast<double>() + Vector3d::Constant(0.5);
    for (size_t i = 2; i < polygon.size(); ++i) {
      here.addTriangle(polygon[0] - middle, polygon[i - 1] - middle, polygon[i] - middle);
    }
  };
  const Vector3d size = grid.cells.cast<double>();
  for (const auto& t : shell.triangles) {
    Polygon triangle;
    for (const uint32_t v : t) {
      // The grid may end slightly before the body: rounding of single-precision meshes.
      const Vector3d cells = (shell.positions_m[v] - grid.origin_m) / grid.spacing_m;
      triangle.push_back(cells.cwiseMax(Vector3d::Zero()).cwiseMin(size));
    }
    cut(triangle, grid.cells, 0, Vector3i::Zero(), visit);
  }
  std::vector<SurfaceCell> sums;
  for (const auto& [cell, here] : pieces) sums.push_back({cell, noFill()});
  std::sort(sums.begin(), sums.end(), [](const SurfaceCell& a, const SurfaceCell& b) { return a.cell < b.cell; });
  Column before = Column::Zero();  // sum over the row so far
  const auto row_length = static_cast<size_t>(grid.cells.x());
  for (size_t i = 0; i < sums.size(); ++i) {
    if (i > 0 && sums[i].cell / row_length != sums[i - 1].cell / row_length) before.setZero();
    const CellPieces& here = pieces.at(sums[i].cell);
    sums[i].sum = fillOf(before);
    add(sums[i].sum, here.beyond);
    before += here.column;
  }
  return sums;
}

}  // namespace viscera
