// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/rest_fill.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace viscera {

namespace {

constexpr double kFillSide = 0.5;    // of the spacing: side of the cube over which the border of tissue is smoothed
constexpr double kSheetReach = 0.5;  // of the spacing: to both sides of a sheet

/// Returns the share above 0 of an interval of length `side` around x, in cells.
double above(double x, double side) {
  return std::clamp(0.5 + x / side, 0.0, 1.0);
}

Vector3i wholeNumbers(const Vector3d& v, double (*how)(double)) {
  return {static_cast<int>(how(v.x())), static_cast<int>(how(v.y())), static_cast<int>(how(v.z()))};
}

/// Returns the thickness of a sheet, from its mass [m].
double thicknessOf(const SpringNetwork& network, double density_kg_per_m3) {
  double mass_kg = 0, area_m2 = 0;
  for (const double node_kg : network.masses_kg) mass_kg += node_kg;
  for (const std::array<uint32_t, 3>& t : network.triangles) {
    const Vector3d& first = network.positions_m[t[0]];
    area_m2 += 0.5 * (network.positions_m[t[1]] - first).cross(network.positions_m[t[2]] - first).norm();
  }
  return mass_kg / (density_kg_per_m3 * area_m2);
}

/// Calls visit(place) for the grid positions within a box [m].
template <class Visit>
void forEachWithin(const RestGrid& grid, const Vector3d& low_m, const Vector3d& high_m, const Visit& visit) {
  const Vector3i low = wholeNumbers((low_m - grid.origin_m) / grid.spacing_m, std::ceil).cwiseMax(0);
  const Vector3i high =
      wholeNumbers((high_m - grid.origin_m) / grid.spacing_m, std::floor).cwiseMin(grid.count - Vector3i::Ones());
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) visit(Vector3i(x, y, z));
    }
  }
}

}  // namespace

RestFill::RestFill(const Body& body, const RestGrid& nodes) : cells_(nodes), side_(kFillSide) {
  if (body.hasCells())
    addCells(body.lattice);
  else
    addSheet(*body.network, body.material.density_kg_per_m3);
}

double RestFill::at(const Vector3d& at_m) const {
  return shares_.empty() ? ofSheet(at_m) : ofCells(at_m);
}

void RestFill::addCells(const Lattice& lattice) {
  shares_.assign(cells_.positions(), 0);
  for (const uint32_t slot : lattice.active_slots) {
    if (lattice.nodes[slot].lo & layout::kCellBit)
      shares_[cells_.at(lattice.nodeAt(slot))] = static_cast<float>(fillOf(lattice, slot).share);
  }
}

void RestFill::addSheet(const SpringNetwork& network, double density_kg_per_m3) {
  thickness_m_ = thicknessOf(network, density_kg_per_m3);
  reach_m_ = std::max(kSheetReach * cells_.spacing_m, thickness_m_);
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  const auto side = [](const std::array<uint32_t, 3>& corners, size_t i) {
    return std::minmax(corners[i], corners[(i + 1) % 3]);
  };
  for (const std::array<uint32_t, 3>& corners : network.triangles) {
    for (size_t i = 0; i < 3; ++i) ++sides[side(corners, i)];
  }
  std::vector<std::vector<uint32_t>> near(cells_.positions());
  const Vector3d around = Vector3d::Constant(reach_m_ + 0.5 * cells_.spacing_m);
  for (const std::array<uint32_t, 3>& corners : network.triangles) {
    const auto triangle = static_cast<uint32_t>(triangles_.size());
    triangles_.emplace_back();
    borders_.emplace_back();
    for (size_t i = 0; i < 3; ++i) {
      triangles_.back()[i] = network.positions_m[corners[i]];
      borders_.back()[i] = sides[side(corners, i)] == 1;
    }
    const auto& [a, b, c] = triangles_.back();
    forEachWithin(cells_, a.cwiseMin(b).cwiseMin(c) - around, a.cwiseMax(b).cwiseMax(c) + around,
                  [&](const Vector3i& node) { near[cells_.at(node)].push_back(triangle); });
  }
  starts_.push_back(0);
  for (const std::vector<uint32_t>& triangles : near) {
    listed_.insert(listed_.end(), triangles.begin(), triangles.end());
    starts_.push_back(static_cast<uint32_t>(listed_.size()));
  }
}

double RestFill::ofCells(const Vector3d& at_m) const {
  const Vector3d middle = (at_m - cells_.origin_m) / cells_.spacing_m;
  const Vector3i face = cells_.nearest(at_m);
  const Vector3d beyond = middle - face.cast<double>();
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i side(c & 1, c >> 1 & 1, c >> 2 & 1), cell = face + side - Vector3i::Ones();
    if (!cells_.has(cell)) continue;
    double part = shares_[cells_.at(cell)];
    for (int a = 0; a < 3; ++a) part *= side[a] ? above(beyond[a], side_) : 1 - above(beyond[a], side_);
    sum += part;
  }
  return std::min(sum, 1.0);
}

/// Returns the share of a sheet, its thickness spread to both sides: the integral along a line across it is its
/// thickness.
double RestFill::ofSheet(const Vector3d& at_m) const {
  const Vector3i cube = cells_.nearest(at_m);
  if (!cells_.has(cube)) return 0;
  double away_m = reach_m_;
  for (uint32_t i = starts_[cells_.at(cube)]; i < starts_[cells_.at(cube) + 1]; ++i)
    away_m = std::min(away_m, awayFrom(listed_[i], at_m));
  return thickness_m_ / reach_m_ * (1 - away_m / reach_m_);
}

/// Returns the distance from a triangle [m]; infinite beyond a border of the sheet.
double RestFill::awayFrom(size_t triangle, const Vector3d& at_m) const {
  const std::array<Vector3d, 3>& p = triangles_[triangle];
  const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
  double outside2 = std::numeric_limits<double>::infinity();
  bool inside = true, ends = false;
  for (size_t i = 0; i < 3; ++i) {
    const Vector3d edge = p[(i + 1) % 3] - p[i], from = at_m - p[i];
    if (normal.cross(edge).dot(from) >= 0) continue;
    inside = false;
    if (borders_[triangle][i]) ends = true;
    const double t = std::clamp(from.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    outside2 = std::min(outside2, (from - t * edge).squaredNorm());
  }
  if (inside) return std::abs(normal.dot(at_m - p[0]));
  return ends ? std::numeric_limits<double>::infinity() : std::sqrt(outside2);
}

}  // namespace viscera
