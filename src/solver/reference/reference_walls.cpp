// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Cells in thin walls, with second derivatives from rows of nodes (physics.md 1, Thin walls).
#include <algorithm>

#include "solver/reference/reference_lattice.h"

namespace viscera {

namespace {

/// Returns the index in a WallMotion, in vectors, of the second derivative along an axis. The next function returns
/// that of its variation along another axis.
constexpr int rowAt(int axis) {
  return 7 + axis;
}
constexpr int variationAt(int axis, int along) {
  return 10 + 2 * axis + (along == (axis + 1) % 3 ? 0 : 1);
}

int sideOf(size_t corner, int axis) {
  return corner >> axis & 1 ? 1 : -1;
}

}  // namespace

void ReferenceLattice::addWall(const WallCell& wall, Cell& cell) {
  cell.law.wall = {wall.normal, Vector3d::Constant(wall.rows), wall.rows, wall.variation};
  for (const uint32_t corner : cell.corners) {
    walls_near_[corner].push_back(cells_.size());
    for (uint32_t s = 0; s < layout::kAxialSprings; ++s) axial_of_walls_.push_back({corner, s, cells_.size()});
  }
}

/// Adds cells in thin walls to the nodes next to their corners, once neighbours are known.
void ReferenceLattice::linkWalls() {
  for (const auto& [corner, spring, cell] : axial_of_walls_) {
    if (isWhole(corner, spring) || hasGhost(nodes[corner], static_cast<int>(spring / 2)))
      walls_near_[farEnd(corner, spring)].push_back(cell);
  }
  axial_of_walls_.clear();
  for (auto& [slot, near] : walls_near_) {
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

bool ReferenceLattice::isWithinRow(uint32_t slot, int axis) const {
  return viscera::isWithinRow(nodes[slot], axis);
}

ReferenceLattice::WallStencil ReferenceLattice::stencilOf(const Cell& cell) const {
  WallStencil out;
  const auto at = [&](uint32_t slot) -> WallShare& {
    const auto known = std::find_if(out.begin(), out.end(), [&](const auto& node) { return node.slot == slot; });
    if (known != out.end()) return known->share;
    out.push_back({slot, WallShare::Zero()});
    return out.back().share;
  };
  for (size_t c = 0; c < 8; ++c) at(cell.corners[c]).head<7>() = motionOfCorner(c, cell.spacing_m);
  for (size_t c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      uint32_t node = cell.corners[c];
      if (!isWithinRow(node, axis)) node = cell.corners[c ^ (size_t{1} << axis)];  // a row ends: uses its neighbour
      if (!isWithinRow(node, axis)) continue;
      WallShare difference = WallShare::Zero();
      difference[rowAt(axis)] = 0.125 / cell.spacing_m;
      for (int along = 0; along < 3; ++along) {
        if (along != axis) difference[variationAt(axis, along)] = 0.25 * sideOf(c, along) / cell.spacing_m;
      }
      const auto first = static_cast<uint32_t>(2 * axis);
      at(node) -= 2 * difference;
      at(farEnd(node, first)) += difference;
      at(farEnd(node, first + 1)) += difference;
    }
  }
  return out;
}

/// Returns the law of a cell with its remaining rows.
LawCell ReferenceLattice::wallLaw(const Cell& cell) const {
  LawCell out = cell.law;
  for (int axis = 0; axis < 3; ++axis) {
    const bool any = std::any_of(cell.corners.begin(), cell.corners.end(),
                                 [&](uint32_t corner) { return isWithinRow(corner, axis); });
    if (!any) out.wall.rows[axis] = 0;
  }
  return out;
}

WallMotion ReferenceLattice::motionOf(const Field& u_m, const WallStencil& stencil) {
  WallMotion out = WallMotion::Zero();
  for (const auto& node : stencil) {
    for (int i = 0; i < 16; ++i) out.segment<3>(3 * i) += node.share[i] * u_m[node.slot];
  }
  return out;
}

/// Calls visit(slot, force) with the forces of a cell on the nodes of its stencil [N].
template <class Visit>
void ReferenceLattice::wallForces(const Field& u_m, const Cell& cell, Visit visit) const {
  const WallStencil stencil = stencilOf(cell);
  const WallMotion gradient = lawCellGradient(wallLaw(cell), motionOf(u_m, stencil));
  for (const auto& node : stencil) {
    Vector3d force = Vector3d::Zero();
    for (int i = 0; i < 16; ++i) force -= node.share[i] * gradient.segment<3>(3 * i);
    visit(node.slot, force);
  }
}

Vector3d ReferenceLattice::wallForce(const Field& u_m, uint32_t slot) const {
  Vector3d sum = Vector3d::Zero();
  const auto near = walls_near_.find(slot);
  if (near == walls_near_.end()) return sum;
  for (const size_t index : near->second) {
    if (!isWholeCell(cells_[index])) continue;
    wallForces(u_m, cells_[index], [&](uint32_t node, const Vector3d& force) {
      if (node == slot) sum += force;
    });
  }
  return sum;
}

void ReferenceLattice::addWallForces(const Field& u_m, Field& forces) const {
  for (const Cell& cell : cells_) {
    if (!cell.isInWall() || !isWholeCell(cell)) continue;
    wallForces(u_m, cell, [&](uint32_t node, const Vector3d& force) { forces[node] += force; });
  }
}

double ReferenceLattice::wallEnergy(const Field& u_m, const Cell& cell) const {
  return lawCellEnergy(wallLaw(cell), motionOf(u_m, stencilOf(cell)));
}

}  // namespace viscera
