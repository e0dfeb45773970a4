// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace viscera {
namespace {

// Integer arithmetic decides whether a line passes through a triangle, so that no line slips between two triangles that
// share an edge. Vertices are rounded to a fine fraction of a cell. A line that meets an edge exactly is treated as
// shifted by an infinitesimal step, first along u, then, infinitely smaller, along v.
using Fine = int64_t;
using FinePoint = std::array<Fine, 3>;  ///< (u, v, coordinate along the line)

/// Coordinates stay below 2^29, so that the product of two differences fits 64 bits.
constexpr double kFineRange = 1 << 28;
constexpr double kHeadOnCosine = 0.57;

struct Crossing {
  int column_u, column_v;
  double at;  ///< cell coordinate along the line
  int step;   ///< change of the winding number
  bool head_on;
};

/// Twice the signed area of (a, b, p), and its sign, which is also defined where the area is zero.
struct SideOfEdge {
  Fine area;
  int sign;
};

int signOf(Fine x) {
  return (x > 0) - (x < 0);
}

SideOfEdge sideOf(const FinePoint& a, const FinePoint& b, Fine u, Fine v) {
  const Fine du = b[0] - a[0], dv = b[1] - a[1];
  const Fine area = du * (v - a[1]) - dv * (u - a[0]);
  if (area != 0) return {area, signOf(area)};
  return {0, dv != 0 ? -signOf(dv) : signOf(du)};
}

/// Intersection of the lines along one axis with triangles.
class LineCaster {
 public:
  LineCaster(const Solid& grid, int axis)
      : grid_(grid),
        axes_{(axis + 1) % 3, (axis + 2) % 3, axis},
        fine_per_cell_(static_cast<Fine>(std::exp2(std::floor(std::log2(kFineRange / (grid.cells.maxCoeff() + 2)))))) {}

  FinePoint toFine(const Vector3d& position_m) const {
    const Vector3d cells = (position_m - grid_.origin_m) / grid_.spacing_m;
    FinePoint fine;
    for (int i = 0; i < 3; ++i) fine[i] = std::llround(cells[axes_[i]] * static_cast<double>(fine_per_cell_));
    return fine;
  }

  void cast(const FinePoint& a, const FinePoint& b, const FinePoint& c, bool head_on) {
    const Fine area = sideOf(a, b, c[0], c[1]).area;
    if (area == 0) return;  // edge-on
    const auto [first_u, last_u] = columns(std::min({a[0], b[0], c[0]}), std::max({a[0], b[0], c[0]}), 0);
    const auto [first_v, last_v] = columns(std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}), 1);
    for (int v = first_v; v <= last_v; ++v) {
      for (int u = first_u; u <= last_u; ++u) castColumn(a, b, c, area, u, v, head_on);
    }
  }

  std::vector<Crossing> crossings;

 private:
  /// Returns the rows of cells with centres within [low, high].
  std::pair<int, int> columns(Fine low, Fine high, int which) const {
    const double per_cell = static_cast<double>(fine_per_cell_);
    const int count = grid_.cells[axes_[which]];
    const int first = static_cast<int>(std::ceil(static_cast<double>(low) / per_cell - 0.5));
    const int last = static_cast<int>(std::floor(static_cast<double>(high) / per_cell - 0.5));
    return {std::max(first, 0), std::min(last, count - 1)};
  }

  void castColumn(const FinePoint& a, const FinePoint& b, const FinePoint& c, Fine area, int column_u, int column_v,
                  bool head_on) {
    const Fine u = fine_per_cell_ * column_u + fine_per_cell_ / 2, v = fine_per_cell_ * column_v + fine_per_cell_ / 2;
    const int side = signOf(area);
    const SideOfEdge bc = sideOf(b, c, u, v), ca = sideOf(c, a, u, v), ab = sideOf(a, b, u, v);
    if (bc.sign != side || ca.sign != side || ab.sign != side) return;
    const double height = (static_cast<double>(bc.area) * a[2] + static_cast<double>(ca.area) * b[2] +
                           static_cast<double>(ab.area) * c[2]) /
                          static_cast<double>(area);
    // Where the normal points back along the line, the line enters.
    crossings.push_back({column_u, column_v, height / static_cast<double>(fine_per_cell_), -side, head_on});
  }

  const Solid& grid_;
  std::array<int, 3> axes_;
  Fine fine_per_cell_;
};

std::vector<InsideStretch> stretchesBetween(std::vector<Crossing>& crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.column_v, a.column_u, a.at) < std::tie(b.column_v, b.column_u, b.at);
  });
  std::vector<InsideStretch> stretches;
  int winding = 0;  // returns to zero at the end of every line, as the shell is closed
  const Crossing* entry = nullptr;
  bool changes = false;
  for (const Crossing& crossing : crossings) {
    if (winding == 0) {
      entry = &crossing;
      changes = false;
    }
    winding += crossing.step;
    changes = changes || winding != (winding == 0 ? 0 : entry->step);
    if (winding != 0) continue;
    const bool head_on = entry->head_on && crossing.head_on;
    stretches.push_back(
        {crossing.column_u, crossing.column_v, entry->at, crossing.at, head_on, changes ? 0 : entry->step});
  }
  return stretches;
}

}  // namespace

std::vector<InsideStretch> insideStretches(const Shell& shell, const Solid& grid, int axis) {
  LineCaster caster(grid, axis);
  std::vector<FinePoint> fine(shell.positions_m.size());
  for (size_t v = 0; v < fine.size(); ++v) fine[v] = caster.toFine(shell.positions_m[v]);
  for (const auto& t : shell.triangles) {
    const Vector3d& a = shell.positions_m[t[0]];
    const Vector3d normal = (shell.positions_m[t[1]] - a).cross(shell.positions_m[t[2]] - a);
    const bool head_on = std::abs(normal[axis]) >= kHeadOnCosine * normal.norm();
    caster.cast(fine[t[0]], fine[t[1]], fine[t[2]], head_on);
  }
  return stretchesBetween(caster.crossings);
}

}  // namespace viscera
