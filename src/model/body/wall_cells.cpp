// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/wall_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "math/decompositions.h"

namespace viscera {
namespace {

// Angles between a wall and the lattice. Walls along the lattice bend correctly with the cell's own second derivatives
// alone, and rows would add errors in shear: bending across two axes at one cell is off by -6 % so, and by -13 % with
// rows.
constexpr double kAlongLattice_deg = 3, kAskew_deg = 10;
/// Thickness in cells from which rows fade, and where they end. In walls of three cells, bending with the cell's own
/// second derivatives is within 2 %.
constexpr double kThin = 2, kThick = 3;
/// The variation of second derivatives makes walls stiffer. Without it, walls of half a cell under tension are 15 % too
/// soft; from three quarters of a cell on, they are within 6 % with a tenth of it and bend better. Cells at a clamp
/// have a quarter: with less, ghosts that vary linearly along the clamp have next to no stiffness and come to rest
/// slowly.
constexpr double kHalfCell = 0.5, kThreeQuarters = 0.75, kLeastVariation = 0.1, kVariationAtClamp = 0.25;
/// Step along the normal for the measurement of a wall's thickness, in cells.
constexpr double kStep = 0.25;
/// Share of tissue below which a point is outside of the wall.
constexpr double kOutside = 0.02;

double fading(double value, double from, double to) {
  return std::clamp((to - value) / (to - from), 0.0, 1.0);
}

/// The cells of a lattice on a dense grid.
class CellGrid {
 public:
  explicit CellGrid(const Lattice& lattice)
      : lattice_(lattice), size_(lattice.nodes_per_axis), slots_(static_cast<size_t>(size_.prod()), kNone) {
    for (const uint32_t slot : lattice.active_slots) {
      if (lattice.cell_labels[slot] == 0) continue;
      slots_[index(lattice.nodeAt(slot))] = slot;
    }
  }

  /// Returns the slot of the lowest corner of a cell; kNone if there is no cell.
  uint32_t at(const Vector3i& cell) const {
    const bool inside = (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
    return inside ? slots_[index(cell)] : kNone;
  }
  double share(const Vector3i& cell) const {
    const uint32_t slot = at(cell);
    return slot == kNone ? 0 : std::min(fillOf(lattice_, slot).share, 1.0);
  }
  /// Returns the share of tissue around a position in cells, by linear interpolation between the centres of cells.
  double shareAt(const Vector3d& position) const {
    const Vector3d from_middle = position.array() - 0.5;
    const Vector3i low = from_middle.array().floor().cast<int>();
    const Vector3d part = from_middle - low.cast<double>();
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      const Vector3i corner(c & 1, c >> 1 & 1, c >> 2 & 1);
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= corner[a] ? part[a] : 1 - part[a];
      if (weight > 0) sum += weight * share(low + corner);
    }
    return sum;
  }

  static constexpr uint32_t kNone = ~0u;

 private:
  size_t index(const Vector3i& cell) const {
    return static_cast<size_t>(cell.x()) +
           static_cast<size_t>(size_.x()) *
               (static_cast<size_t>(cell.y()) + static_cast<size_t>(size_.y()) * static_cast<size_t>(cell.z()));
  }

  const Lattice& lattice_;
  Vector3i size_;
  std::vector<uint32_t> slots_;
};

/// Returns the covariance of the tissue around a cell in cells squared. The weight of each of its 27 neighbours is
/// halved for each axis along which it differs from the cell.
Matrix3d tissueAround(const Lattice& lattice, const CellGrid& grid, const Vector3i& cell) {
  double sum = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (int n = 0; n < 27; ++n) {
    const Vector3i off(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const uint32_t slot = grid.at(cell + off);
    if (slot == CellGrid::kNone) continue;
    const CellFill fill = fillOf(lattice, slot);
    const double weight = std::pow(0.5, off.cwiseAbs().sum());
    const Vector3d at = off.cast<double>();
    sum += weight * fill.share;
    first += weight * (fill.first + fill.share * at);
    second += weight * (fill.second + fill.first * at.transpose() + at * fill.first.transpose() +
                        fill.share * at * at.transpose());
  }
  first /= sum;
  return second / sum - first * first.transpose();
}

/// Returns the length of tissue on a line through a position within the wall, in cells, at most kThick.
double thicknessAt(const CellGrid& grid, const Vector3d& position, const Vector3d& normal) {
  double sum = kStep * grid.shareAt(position);
  for (const double sign : {1.0, -1.0}) {
    for (int n = 1; sum < kThick; ++n) {
      const double share = grid.shareAt(position + sign * n * kStep * normal);
      if (share < kOutside) break;
      sum += kStep * share;
    }
  }
  return std::min(sum, kThick);
}

/// Returns the thickness of the wall through a cell in cells, at most kThick.
double thicknessOf(const Lattice& lattice, const CellGrid& grid, uint32_t slot, const Vector3d& normal) {
  const CellFill fill = fillOf(lattice, slot);
  const Vector3d middle = lattice.nodeAt(slot).cast<double>().array() + 0.5;
  return thicknessAt(grid, middle + fill.first / fill.share, normal);
}

/// Returns the largest thickness among a cell and its neighbours. Next to a clamp or a rim the measured one is too
/// small.
double thicknessAround(const CellGrid& grid, const std::map<uint32_t, double>& thickness, const Vector3i& cell) {
  double out = 0;
  for (int n = 0; n < 27; ++n) {
    const auto found = thickness.find(grid.at(cell + Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
    if (found != thickness.end()) out = std::max(out, found->second);
  }
  return out;
}

bool isAtClamp(const Lattice& lattice, uint32_t slot) {
  bool out = false;
  forEachCorner(lattice, slot, [&](const Vector3i&, uint32_t corner) { out = out || isFixed(lattice.nodes[corner]); });
  return out;
}

/// Returns the share of the variation that counts where all of the second derivatives are from rows.
double variationOf(double thickness) {
  return kLeastVariation + (kRowVariation - kLeastVariation) * fading(thickness, kHalfCell, kThreeQuarters);
}

/// Least share of the tissue around a fixed node, weighted by the square of its cells' rows, for which the node gets
/// ghosts. A ghost has the mass of its node, so its frequency falls with this share. A ghost that is hardly coupled
/// would take long to come to rest and change little.
constexpr double kLeastCoupled = 0.25;

/// Bricks of a lattice by their coordinates, and new ones beyond its bounds.
class BrickGrid {
 public:
  explicit BrickGrid(Lattice& lattice) : lattice_(lattice) {
    for (uint32_t b = 0; b < lattice.bricks.size(); ++b) bricks_[key(coordinates(b))] = b;
  }

  /// Returns the slot at integer coordinates of any sign, in a new brick where there is none.
  uint32_t slotAt(const Vector3i& node) {
    constexpr int kEdge = static_cast<int>(layout::kBrickEdge);
    Vector3i brick, within;
    for (int axis = 0; axis < 3; ++axis) {
      within[axis] = ((node[axis] % kEdge) + kEdge) % kEdge;
      brick[axis] = (node[axis] - within[axis]) / kEdge;
    }
    const auto known = bricks_.find(key(brick));
    const uint32_t b = known != bricks_.end() ? known->second : add(brick);
    return b * layout::kBrickSlots + static_cast<uint32_t>(within.x() + kEdge * (within.y() + kEdge * within.z()));
  }

 private:
  using Key = std::tuple<int, int, int>;
  static Key key(const Vector3i& brick) { return {brick.x(), brick.y(), brick.z()}; }
  Vector3i coordinates(uint32_t b) const {
    return {lattice_.bricks[b].coord_x, lattice_.bricks[b].coord_y, lattice_.bricks[b].coord_z};
  }

  uint32_t add(const Vector3i& at) {
    const auto out = static_cast<uint32_t>(lattice_.bricks.size());
    layout::Brick brick{};
    brick.coord_x = at.x();
    brick.coord_y = at.y();
    brick.coord_z = at.z();
    for (int d = 0; d < 27; ++d) {
      const auto known = bricks_.find(key(at + Vector3i(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1)));
      brick.neighbors[d] = known == bricks_.end() ? out : known->second;
      if (known != bricks_.end()) lattice_.bricks[known->second].neighbors[26 - d] = out;
    }
    lattice_.bricks.push_back(brick);
    bricks_[key(at)] = out;
    extend();
    return out;
  }
  /// Extends the numbers per slot to the new brick.
  void extend() {
    const size_t slots = lattice_.bricks.size() * layout::kBrickSlots;
    lattice_.nodes.resize(slots);
    lattice_.labels.resize(slots);
    lattice_.cell_labels.resize(slots);
    if (!lattice_.cell_fills.empty()) lattice_.cell_fills.resize(slots);
    if (!lattice_.depth_m.empty()) lattice_.depth_m.resize(slots, static_cast<float>(lattice_.spacing_m));
    if (!lattice_.offset_to_surface_m.empty()) lattice_.offset_to_surface_m.resize(slots, Eigen::Vector3f::Zero());
  }

  Lattice& lattice_;
  std::map<Key, uint32_t> bricks_;
};

/// Returns the spring index from a fixed node out of the tissue along an axis, if the spring on its other side leads to
/// a node that is not fixed; else -1.
int springOut(const Lattice& lattice, uint32_t slot, int axis) {
  const layout::NodeBits& bits = lattice.nodes[slot];
  const auto first = static_cast<uint32_t>(2 * axis);
  const bool up = springCount(bits, first) != 0, down = springCount(bits, first + 1) != 0;
  if (up == down) return -1;
  const uint32_t inwards = up ? first : first + 1;
  const int64_t inner = lattice.neighborSlot(slot, inwards);
  if (inner < 0 || isFixed(lattice.nodes[static_cast<size_t>(inner)])) return -1;
  const uint32_t outwards = oppositeSpring(inwards);
  return lattice.neighborSlot(slot, outwards) < 0 ? static_cast<int>(outwards) : -1;
}

}  // namespace

std::vector<WallCell> wallCells(const Body& body) {
  std::vector<WallCell> out;
  const Lattice& lattice = body.lattice;
  if (body.material.law != Law::kNeoHookean || body.material.walls != Walls::kRows || !body.hasCells() ||
      body.network || lattice.fills.empty() || !body.prestress.empty())
    return out;
  const CellGrid grid(lattice);
  std::map<uint32_t, double> thickness;
  for (const uint32_t slot : lattice.active_slots) {
    if (lattice.cell_labels[slot] == 0) continue;
    const Vector3i cell = lattice.nodeAt(slot);
    const Vector3d normal = principalAxes(tissueAround(lattice, grid, cell)).axes.col(0);
    const double cosine = std::min(1.0, normal.cwiseAbs().maxCoeff());
    const double askew_deg = std::acos(cosine) * 180 / M_PI;
    const double askew = 1 - fading(askew_deg, kAlongLattice_deg, kAskew_deg);
    if (askew == 0) continue;
    const double cells = thickness[slot] = thicknessOf(lattice, grid, slot, normal);
    const double rows = askew * fading(cells, kThin, kThick);
    if (rows > 0) out.push_back({slot, normal, rows, 0});
  }
  for (WallCell& wall : out) {
    const double cells = thicknessAround(grid, thickness, lattice.nodeAt(wall.cell));
    wall.variation = wall.rows * (isAtClamp(lattice, wall.cell) ? kVariationAtClamp : variationOf(cells));
  }
  return out;
}

void addRowGhosts(Body& body) {
  Lattice& lattice = body.lattice;
  std::map<uint32_t, double> coupled;  // of fixed nodes: sum of their cells' shares times the square of rows
  for (const WallCell& wall : wallCells(body)) {
    const double share = fillOf(lattice, wall.cell).share * wall.rows * wall.rows;
    forEachCorner(lattice, wall.cell, [&](const Vector3i& /*corner*/, uint32_t slot) {
      if (isFixed(lattice.nodes[slot])) coupled[slot] += share;
    });
  }
  if (coupled.empty()) return;
  std::map<uint32_t, double> all;  // the sum of their cells' shares
  for (const uint32_t cell : lattice.active_slots) {
    if (lattice.cell_labels[cell] == 0) continue;
    forEachCorner(lattice, cell, [&](const Vector3i& /*corner*/, uint32_t slot) {
      if (isFixed(lattice.nodes[slot])) all[slot] += fillOf(lattice, cell).share;
    });
  }
  BrickGrid grid(lattice);
  for (const auto& [slot, share] : coupled) {
    if (share < kLeastCoupled * all.at(slot)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const int out = springOut(lattice, slot, axis);
      if (out < 0) continue;
      const auto spring = static_cast<uint32_t>(out);
      const auto& offset = kNeighborOffsets[spring];
      const uint32_t ghost = grid.slotAt(lattice.nodeAt(slot) + Vector3i(offset[0], offset[1], offset[2]));
      if (isGhost(lattice.nodes[ghost])) continue;
      lattice.nodes[ghost].lo =
          layout::kGhostBit | layout::kFixedBit | oppositeSpring(spring) << layout::kGhostRowShift;
      lattice.nodes[slot].lo |= 1u << (layout::kGhostRowShift + static_cast<uint32_t>(axis));
      lattice.ghosts.push_back({ghost, slot, spring});
    }
  }
  std::sort(lattice.ghosts.begin(), lattice.ghosts.end(),
            [](const RowGhost& a, const RowGhost& b) { return a.slot < b.slot; });
}

}  // namespace viscera
