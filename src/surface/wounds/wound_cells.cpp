// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surface/skins/keep_room.h"

namespace viscera {

namespace {

constexpr float kMargin =
    0.02F;  // of a cell: distance of centres from its faces, so that every tetrahedron has a volume
constexpr float kNowhere = 1e-6F;  // a point nearer to a centre than this has no definite side

constexpr int kEdge = static_cast<int>(layout::kBrickEdge);

/// Returns the other two axes of a face, ascending.
std::array<int, 2> axesOf(int normal) {
  return {normal == 0 ? 1 : 0, normal == 2 ? 1 : 2};
}

/// Returns the edge of a cell along `axis` at the corner bits of the other two axes.
int edgeAt(int axis, int corner) {
  const auto [u, v] = axesOf(axis);
  return 4 * axis + (corner >> u & 1) + 2 * (corner >> v & 1);
}

Vector3f positionOnEdge(int edge, float share) {
  const int low = edgeCorners(edge)[0];
  Vector3f position(static_cast<float>(low & 1), static_cast<float>(low >> 1 & 1), static_cast<float>(low >> 2));
  position[edge / 4] = share;
  return position;
}

/// Returns the axis of the face through which a direction from a point leaves the unit cube (in two dimensions:
/// square), and the multiple of the direction to there. Returns -1 for a direction of almost no length.
template <int Dimensions>
std::pair<int, float> exit(const Eigen::Matrix<float, Dimensions, 1>& from,
                           const Eigen::Matrix<float, Dimensions, 1>& direction) {
  std::pair<int, float> out(-1, std::numeric_limits<float>::infinity());
  for (int axis = 0; axis < Dimensions; ++axis) {
    if (std::abs(direction[axis]) < kNowhere) continue;
    const float reach = ((direction[axis] > 0 ? 1.0F : 0.0F) - from[axis]) / direction[axis];
    if (reach < out.second) out = {axis, reach};
  }
  return out;
}

float inside(float value) {
  return std::clamp(value, kMargin, 1 - kMargin);
}

}  // namespace

int CutCell::cornerOf(uint32_t slot) const {
  const auto found = std::find(slots.begin(), slots.end(), slot);
  return found == slots.end() ? -1 : static_cast<int>(found - slots.begin());
}

int CutCell::cornerAt(const Vector3f& position) const {
  const auto [normal, to_face] = exit<3>(centre, position - centre);
  if (normal < 0) return 0;
  const Vector3f direction = position - centre;
  const int side = direction[normal] > 0 ? 1 : 0;
  const auto axes = axesOf(normal);
  const Eigen::Vector2f& middle = face_centre[2 * static_cast<size_t>(normal) + static_cast<size_t>(side)];
  const Eigen::Vector2f along =
      Eigen::Vector2f(centre[axes[0]] + to_face * direction[axes[0]], centre[axes[1]] + to_face * direction[axes[1]]) -
      middle;
  const auto [across, to_edge] = exit<2>(middle, along);
  int corner = side << normal;
  if (across < 0) return corner;
  const int other = 1 - across, last = axes[static_cast<size_t>(other)];
  corner |= (along[across] > 0 ? 1 : 0) << axes[static_cast<size_t>(across)];
  const float on_edge = middle[other] + to_edge * along[other];
  return corner | (on_edge > crossed[static_cast<size_t>(edgeAt(last, corner))] ? 1 : 0) << last;
}

CutCells::CutCells(const Lattice& lattice)
    : lattice_(lattice),
      nodes_(lattice.nodes),
      axial_cut_(3 * lattice.nodes.size()),
      numbers_(lattice.nodes.size()),
      seen_(lattice.nodes.size()) {
  bricks_per_axis_ = (lattice.nodes_per_axis.array() + kEdge - 1) / kEdge;
  brick_at_.assign(static_cast<size_t>(bricks_per_axis_.prod()), 0);
  for (size_t b = 0; b < lattice.bricks.size(); ++b) {
    const Vector3i at(lattice.bricks[b].coord_x, lattice.bricks[b].coord_y, lattice.bricks[b].coord_z);
    if ((at.array() < 0).any() || (at.array() >= bricks_per_axis_.array()).any()) continue;  // of ghosts alone
    brick_at_[static_cast<size_t>(at.x() + bricks_per_axis_.x() * (at.y() + bricks_per_axis_.y() * at.z()))] =
        static_cast<uint32_t>(b) + 1;
  }
}

int64_t CutCells::slotAt(const Vector3i& node) const {
  constexpr auto kSide = static_cast<uint32_t>(kEdge);  // unsigned: divisions by it are shifts
  const auto x = static_cast<uint32_t>(node.x()), y = static_cast<uint32_t>(node.y()),
             z = static_cast<uint32_t>(node.z());
  const Vector3i& end = lattice_.nodes_per_axis;  // below zero is outside too
  if (x >= static_cast<uint32_t>(end.x()) || y >= static_cast<uint32_t>(end.y()) || z >= static_cast<uint32_t>(end.z()))
    return -1;
  const auto along_x = static_cast<size_t>(bricks_per_axis_.x()), along_y = static_cast<size_t>(bricks_per_axis_.y());
  const uint32_t found = brick_at_[x / kSide + along_x * (y / kSide + along_y * (z / kSide))];
  if (found == 0) return -1;
  const int64_t slot =
      int64_t{layout::kBrickSlots} * (found - 1) + x % kSide + kSide * (y % kSide + kSide * (z % kSide));
  return lattice_.labels[static_cast<size_t>(slot)] != 0 ? slot : -1;
}

bool CutCells::isCell(const Vector3i& at) const {
  const int64_t slot = slotAt(at);
  return slot >= 0 && lattice_.cell_labels[static_cast<size_t>(slot)] != 0;
}

bool CutCells::isGone(uint32_t slot) const {
  const layout::NodeBits& bits = nodes_[slot];
  return (bits.lo & layout::kSeveredBit) != 0 && (bits.lo & layout::kAxialMask) == 0 &&
         (bits.hi & layout::kDiagonalMask) == 0;
}

/// Returns whether a spring along an axis is cut, other than between two nodes without springs.
bool CutCells::isCut(uint32_t low, uint32_t high, int axis) const {
  const auto spring = static_cast<uint32_t>(2 * axis);
  return isSevered(low) && springCount(lattice_.nodes[low], spring) != 0 && !isAlive(low, spring) &&
         !(isGone(low) && isGone(high));
}

void CutCells::updateCell(uint32_t lowest) {
  CutCell cell;
  cell.at = lattice_.nodeAt(lowest);
  for (int c = 0; c < 8; ++c)
    cell.slots[static_cast<size_t>(c)] = static_cast<uint32_t>(slotAt(cell.at + Vector3i(c & 1, c >> 1 & 1, c >> 2)));
  cell.order = UINT64_MAX;
  for (int e = 0; e < 12; ++e) {
    const auto [low, high] = edgeCorners(e);
    const uint32_t slot = cell.slots[static_cast<size_t>(low)];
    if (!isCut(slot, cell.slots[static_cast<size_t>(high)], e / 4)) continue;
    cell.cut |= 1U << e;
    cell.order = std::min(cell.order, uint64_t{slot} * 12 + static_cast<uint64_t>(e));
  }
  uint32_t& number = numbers_[lowest];
  if (cell.cut == 0 && number == 0) return;
  if (number == 0) {
    keepRoom(cells_, cells_.size() + 1);
    cells_.emplace_back();
    number = static_cast<uint32_t>(cells_.size());
  }
  cut_cells_ += cell.cut != 0 ? 1 : 0;
  cut_cells_ -= cells_[number - 1].cut != 0 ? 1 : 0;
  if (cell.cut != 0) complete(cell);
  cells_[number - 1] = cell;
}

/// Computes the sides and centres of a cut cell.
void CutCells::complete(CutCell& cell) const {
  for (size_t c = 0; c < 8; ++c) cell.component[c] = static_cast<uint8_t>(c);
  cell.crossed.fill(0.5F);
  Vector3f sum = Vector3f::Zero();
  std::array<Eigen::Vector2f, 6> face_sum;
  face_sum.fill(Eigen::Vector2f::Zero());
  std::array<int, 6> on_face{};
  int count = 0;
  for (int e = 0; e < 12; ++e) {
    const auto [low, high] = edgeCorners(e);
    if ((cell.cut >> e & 1U) == 0) {  // joins two components
      const uint8_t a = cell.component[static_cast<size_t>(low)], b = cell.component[static_cast<size_t>(high)];
      for (uint8_t& component : cell.component) component = component == std::max(a, b) ? std::min(a, b) : component;
      continue;
    }
    const float share = axial_cut_[3 * size_t{cell.slots[static_cast<size_t>(low)]} + static_cast<size_t>(e / 4)];
    if (share > 0 && share < 1) cell.crossed[static_cast<size_t>(e)] = share;
    const Vector3f position = positionOnEdge(e, cell.crossed[static_cast<size_t>(e)]);
    sum += position;
    ++count;
    for (const int axis : axesOf(e / 4)) {
      const auto face = static_cast<size_t>(2 * axis + (low >> axis & 1));
      const auto axes = axesOf(axis);
      face_sum[face] += Eigen::Vector2f(position[axes[0]], position[axes[1]]);
      ++on_face[face];
    }
  }
  cell.centre = (sum / static_cast<float>(count)).unaryExpr(&inside);
  for (size_t f = 0; f < 6; ++f) {
    cell.face_centre[f] = on_face[f] == 0
                              ? Eigen::Vector2f::Constant(0.5F)
                              : Eigen::Vector2f((face_sum[f] / static_cast<float>(on_face[f])).unaryExpr(&inside));
  }
}

void CutCells::findChanged(const layout::NodeBits* nodes, const float* axial_cut) {
  constexpr uint32_t kLow = layout::kAxialMask | layout::kSeveredBit, kHigh = layout::kDiagonalMask;
  changed_slots_.clear();
  for (const uint32_t slot : lattice_.active_slots) {
    layout::NodeBits& known = nodes_[slot];
    const layout::NodeBits now = nodes[slot];
    float* const known_cut = &axial_cut_[3 * size_t{slot}];
    const float* const from = axial_cut ? axial_cut + 3 * size_t{slot} : known_cut;
    if (((now.lo ^ known.lo) & kLow) == 0 && ((now.hi ^ known.hi) & kHigh) == 0 &&
        std::equal(from, from + 3, known_cut))
      continue;
    severed_nodes_ -= isSevered(slot) ? 1 : 0;
    known = now;
    severed_nodes_ += isSevered(slot) ? 1 : 0;
    if (from != known_cut) std::copy_n(from, 3, known_cut);
    keepRoom(changed_slots_, changed_slots_.size() + 1);
    changed_slots_.push_back(slot);
  }
}

void CutCells::makeWhole() {
  nodes_ = lattice_.nodes;
  std::fill(axial_cut_.begin(), axial_cut_.end(), 0.0F);
  changed_slots_.clear();
  changed_cells_.clear();
  severed_nodes_ = 0;
  clear();
}

void CutCells::clear() {
  for (const CutCell& cell : cells_) numbers_[static_cast<size_t>(slotAt(cell.at))] = 0;
  cells_.clear();
  cut_cells_ = 0;
}

void CutCells::update(const layout::NodeBits* nodes, const float* axial_cut) {
  findChanged(nodes, axial_cut);
  changed_cells_.clear();
  if (isWhole()) return clear();
  ++mark_;
  for (const uint32_t slot : changed_slots_) {
    const Vector3i node = lattice_.nodeAt(slot);
    for (int c = 0; c < 8; ++c) {
      const Vector3i lowest = node - Vector3i(c & 1, c >> 1 & 1, c >> 2);
      if (!isCell(lowest)) continue;
      const auto cell = static_cast<uint32_t>(slotAt(lowest));
      if (seen_[cell] == mark_) continue;
      seen_[cell] = mark_;
      keepRoom(changed_cells_, changed_cells_.size() + 1);
      changed_cells_.push_back(cell);
      updateCell(cell);
    }
  }
}

/// Returns the nearest cell to a point outside all cells. Searches shells around it until no farther one can be nearer.
Vector3i CutCells::nearestCell(const Vector3d& point) const {
  const Vector3i home = point.array().floor().cast<int>();
  double best = std::numeric_limits<double>::infinity();
  Vector3i nearest = home;
  for (int radius = 1; radius <= 3 && best > (radius - 1.0) * (radius - 1.0); ++radius) {
    for (int z = -radius; z <= radius; ++z)
      for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) {
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != radius) continue;
          const Vector3i at = home + Vector3i(x, y, z);
          if (!isCell(at)) continue;
          const Vector3d low = at.cast<double>(), high = low + Vector3d::Ones();
          const double distance2 = (point - point.cwiseMax(low).cwiseMin(high)).squaredNorm();
          if (distance2 < best) {
            best = distance2;
            nearest = at;
          }
        }
  }
  return nearest;
}

WoundPoint CutCells::positionOf(const Vector3d& point) const {
  Vector3i home = point.array().floor().cast<int>();
  int64_t lowest = slotAt(home);
  if (lowest < 0 || lattice_.cell_labels[static_cast<size_t>(lowest)] == 0) {
    home = nearestCell(point);
    lowest = slotAt(home);
  }
  WoundPoint position;
  if (lowest < 0) return position;  // nothing within three cells: callers have no surface there
  position.cell = static_cast<uint32_t>(lowest);
  position.within = (point - home.cast<double>()).cwiseMax(0.0).cwiseMin(1.0).cast<float>();
  if (const CutCell* const cell = find(position.cell)) {
    position.node = cell->slots[static_cast<size_t>(cell->cornerAt(position.within))];
    return position;
  }
  const Vector3i corner =
      home + Vector3i(position.within.x() > 0.5F, position.within.y() > 0.5F, position.within.z() > 0.5F);
  position.node = static_cast<uint32_t>(slotAt(corner));
  return position;
}

bool CutCells::areParted(uint32_t node, uint32_t other) const {
  if (node == other) return false;
  const Vector3i a = lattice_.nodeAt(node), b = lattice_.nodeAt(other);
  if ((a - b).cwiseAbs().maxCoeff() > 1) return false;
  if ((a - b).cwiseAbs().sum() == 1) {
    for (uint32_t spring = 0; spring < layout::kAxialSprings; ++spring) {
      const auto& o = kNeighborOffsets[spring];
      if (b - a == Vector3i(o[0], o[1], o[2])) return !isAlive(node, spring);
    }
  }
  // A cell that contains both nodes: one of up to four.
  const Vector3i low = a.cwiseMin(b), span = (a - b).cwiseAbs();
  bool shared = false;
  for (int k = 0; k < 8; ++k) {
    const Vector3i shift(k & 1, k >> 1 & 1, k >> 2);
    if ((shift.array() * span.array()).any()) continue;
    const int64_t lowest = slotAt(low - shift);
    if (lowest < 0) continue;
    const CutCell* const cell = find(static_cast<uint32_t>(lowest));
    if (cell == nullptr) {
      if (isCell(low - shift)) return false;
      continue;
    }
    shared = true;
    if (cell->component[static_cast<size_t>(cell->cornerOf(node))] ==
        cell->component[static_cast<size_t>(cell->cornerOf(other))]) {
      return false;
    }
  }
  return shared;
}

}  // namespace viscera
