// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/cell_fill.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "math/decompositions.h"

namespace viscera {

CellFill noFill() {
  return {0, Vector3d::Zero(), Eigen::Matrix3d::Zero()};
}

void add(CellFill& sum, const CellFill& piece, double times) {
  sum.share += times * piece.share;
  sum.first += times * piece.first;
  sum.second += times * piece.second;
}

CellFill boxFill(const Vector3d& low, const Vector3d& high) {
  const Vector3d size = high - low, middle = 0.5 * (low + high);
  const double share = size.prod();
  const Eigen::Matrix3d spread = (size.cwiseProduct(size) / 12).asDiagonal();
  return {share, share * middle, share * (spread + middle * middle.transpose())};
}

CellFill tetFill(const std::array<Vector3d, 4>& corners) {
  const Vector3d &a = corners[0], &b = corners[1], &c = corners[2], &d = corners[3];
  const double share = std::abs((b - a).cross(c - a).dot(d - a)) / 6;
  const Vector3d sum = a + b + c + d;
  const Eigen::Matrix3d squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + d * d.transpose();
  return {share, 0.25 * share * sum, share / 20 * (squares + sum * sum.transpose())};
}

namespace {

/// Returns the moments of the same tissue relative to the centre of a cell at -d.
CellFill movedBy(const CellFill& fill, const Vector3d& d) {
  const Eigen::Matrix3d cross = fill.first * d.transpose();
  return {fill.share, fill.first + fill.share * d,
          fill.second + cross + cross.transpose() + fill.share * d * d.transpose()};
}

/// Labelled neighbour of a cell across a face, and the step to it.
struct Neighbor {
  size_t cell;
  Vector3i offset;
};

/// Returns the neighbour across the face that a position within the cell is nearest to.
std::optional<Neighbor> nearestNeighbor(const Solid& solid, size_t cell, const Vector3d& position) {
  const auto nx = static_cast<size_t>(solid.cells.x()), ny = static_cast<size_t>(solid.cells.y());
  const Vector3i at(static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny), static_cast<int>(cell / nx / ny));
  std::optional<Neighbor> nearest;
  double farthest_out = -1;
  for (int face = 0; face < 6; ++face) {
    const Vector3i offset = (face % 2 ? 1 : -1) * Vector3i::Unit(face / 2), there = at + offset;
    const double out = position.dot(offset.cast<double>());
    if (out <= farthest_out || solid.label(there.x(), there.y(), there.z()) == 0) continue;
    farthest_out = out;
    nearest = {solid.index(there.x(), there.y(), there.z()), offset};
  }
  return nearest;
}

}  // namespace

bool isPossible(const CellFill& fill) {
  constexpr double kRounding = 1e-9;
  if (!(fill.share > 0) || fill.share > 1 + kLeastGap) return false;
  const Vector3d middle = fill.first / fill.share;
  if (middle.cwiseAbs().maxCoeff() > 0.5) return false;
  const Eigen::Matrix3d spread = fill.second / fill.share - middle * middle.transpose();
  return principalValues(spread).minCoeff() >= -kRounding;
}

void giveSlivers(const std::vector<PartialCell>& slivers, Solid& solid) {
  std::map<size_t, CellFill> given;
  for (const PartialCell& sliver : slivers) {
    if (!(sliver.fill.share > 0)) continue;
    const auto to = nearestNeighbor(solid, sliver.cell, sliver.fill.first / sliver.fill.share);
    if (!to) continue;
    add(given.try_emplace(to->cell, noFill()).first->second, movedBy(sliver.fill, -to->offset.cast<double>()));
  }
  for (PartialCell& p : solid.partial) {
    const auto found = given.find(p.cell);
    if (found == given.end()) continue;
    add(p.fill, found->second);
    given.erase(found);
  }
  for (const auto& [cell, more] : given) {  // for cells that were full
    if (more.share < kLeastGap) continue;
    solid.partial.push_back({cell, CellFill{}});
    add(solid.partial.back().fill, more);
  }
  std::sort(solid.partial.begin(), solid.partial.end(),
            [](const PartialCell& a, const PartialCell& b) { return a.cell < b.cell; });
}

}  // namespace viscera
