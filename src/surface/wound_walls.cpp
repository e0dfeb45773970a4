// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wound_walls.h"

#include <algorithm>
#include <array>

#include "surface/keep_room.h"

namespace viscera {

namespace {

/// The cell beside another one.
int64_t cellAt(const CutCells& cells, const Vector3i& at) {
  const int64_t lowest = cells.slotAt(at);
  return lowest >= 0 && cells.find(static_cast<uint32_t>(lowest)) != nullptr ? lowest : -1;
}

/// The four cells around the spring from the lowest corner of a cell along an axis, counter-clockwise seen from its far
/// end.
std::array<Vector3i, 4> cellsAround(const Vector3i& at, int axis) {
  const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
  return {at, at - u, at - u - v, at - v};
}

/// Across the wound, from the side of a component: the sum of its cut edges.
Vector3d outwardOf(const CutCell& cut, uint8_t component) {
  Vector3d outward = Vector3d::Zero();
  for (int e = 0; e < 12; ++e) {
    if ((cut.cut >> e & 1U) == 0) continue;
    const auto [low, high] = edgeCorners(e);
    outward[e / 4] += (cut.component[static_cast<size_t>(low)] == component ? 1 : 0) -
                      (cut.component[static_cast<size_t>(high)] == component ? 1 : 0);
  }
  return outward;
}

}  // namespace

uint32_t WoundWalls::addVertex(const WoundVertex& vertex, uint32_t cell, const Vector3d& outward) {
  vertices_.push_back(vertex);
  cell_of_.push_back(cell);
  outward_.push_back(outward);
  return static_cast<uint32_t>(vertices_.size() - 1);
}

uint32_t WoundWalls::pointVertex(uint32_t cell, uint8_t component) {
  const CutCell& cut = *cells_->find(cell);
  const uint32_t number = cells_->numberOf(cell);
  uint32_t& known = point_vertices_[8 * size_t{number} + component];
  if (known != kNone) return known;
  WoundVertex vertex;
  const Point& point = points_[number];
  vertex.point = point.marks > 0 ? point.at : Vector3d(cut.at.cast<double>() + cut.centre.cast<double>());
  vertex.place = {cell, Vector3f::Zero(), 0};
  double nearest = -1;
  for (size_t c = 0; c < 8; ++c) {
    if (cut.component[c] != component) continue;
    const double distance2 = (vertex.point - cells_->lattice().nodeAt(cut.slots[c]).cast<double>()).squaredNorm();
    if (nearest >= 0 && distance2 >= nearest) continue;
    nearest = distance2;
    vertex.place.node = cut.slots[c];
  }
  known = addVertex(vertex, number, outwardOf(cut, component));
  return known;
}

uint32_t WoundWalls::lipVertex(uint32_t skin_vertex) {
  uint32_t& known = lip_vertices_[skin_vertex];
  if (known == kNone)
    known = addVertex({skin_->pointOf(skin_vertex), Vector3d::Zero(), {}, skin_vertex}, kNone, Vector3d::Zero());
  return known;
}

void WoundWalls::add(uint32_t a, uint32_t b, uint32_t c) {
  if (a != b && b != c && c != a) triangles_.insert(triangles_.end(), {a, b, c});
}

/// Does the spring from a node along an axis cross the wound inside the tissue? Not where the lattice ends: there the
/// skin does.
bool WoundWalls::isInside(uint32_t slot, int axis) const {
  const Lattice& lattice = cells_->lattice();
  const Vector3i at = lattice.nodeAt(slot);
  for (const Vector3i& around : cellsAround(at, axis)) {
    if (cellAt(*cells_, around) < 0) return false;
  }
  if (lattice.depth_m.empty()) return true;
  const int edge = 4 * axis;  // of the cell that begins there
  const float share = cells_->find(slot)->crossed[static_cast<size_t>(edge)];
  const auto far = static_cast<size_t>(cells_->slotAt(at + Vector3i::Unit(axis)));
  return (1 - share) * lattice.depth_m[slot] + share * lattice.depth_m[far] > 0;
}

/// Means of where springs inside the tissue and the skin are cut.
void WoundWalls::findPoints() {
  const auto note = [&](uint32_t number, const Vector3d& at) {
    points_[number].at += at;
    ++points_[number].marks;
  };
  for (const CutCell& cell : cells_->cells()) {
    for (int e = 0; e < 12; ++e) {
      if ((cell.cut >> e & 1U) == 0) continue;
      const int axis = e / 4;
      const uint32_t slot = cell.slots[static_cast<size_t>(edgeCorners(e)[0])];
      if (!isInside(slot, axis)) continue;
      Vector3d at = cells_->lattice().nodeAt(slot).cast<double>();
      at[axis] += static_cast<double>(cell.crossed[static_cast<size_t>(e)]);
      note(cells_->numberOf(cell.slots[0]), at);
    }
  }
  for (const Lip& lip : skin_->lips()) {
    if (lip.cell != Lip::kNoCell)
      note(cells_->numberOf(lip.cell), (skin_->pointOf(lip.from) + skin_->pointOf(lip.to)) / 2);
  }
  for (Point& point : points_) {
    if (point.marks > 0) point.at /= point.marks;
  }
}

void WoundWalls::addQuads() {
  for (const CutCell& cell : cells_->cells()) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((cell.cut >> (4 * axis) & 1U) == 0 || !isInside(cell.slots[0], axis)) continue;
      const uint32_t low = cell.slots[0];
      const auto high = static_cast<uint32_t>(cells_->slotAt(cell.at + Vector3i::Unit(axis)));
      std::array<uint32_t, 4> of_low{}, of_high{};
      for (size_t i = 0; i < 4; ++i) {
        const auto around = static_cast<uint32_t>(cellAt(*cells_, cellsAround(cell.at, axis)[i]));
        of_low[i] = pointVertex(around, sideOf(around, low));
        of_high[i] = pointVertex(around, sideOf(around, high));
      }
      if (of_low == of_high) continue;  // the cut ends around it: its sides are one
      const bool across = isBetterAcross(of_low);
      if (!cells_->isGone(low)) addQuad(of_low, across);
      if (!cells_->isGone(high)) addQuad({of_high[0], of_high[3], of_high[2], of_high[1]}, across);
    }
  }
}

void WoundWalls::addQuad(const std::array<uint32_t, 4>& around, bool other_diagonal) {
  const size_t first = other_diagonal ? 1 : 0;
  add(around[first], around[first + 1], around[first + 2]);
  add(around[first], around[first + 2], around[(first + 3) % 4]);
}

/// Are the triangles of a quad better shaped with the diagonal from its second corner?
bool WoundWalls::isBetterAcross(const std::array<uint32_t, 4>& around) const {
  std::array<Vector3d, 4> at;
  Vector3d outward = Vector3d::Zero();
  for (size_t i = 0; i < 4; ++i) {
    at[i] = vertices_[around[i]].point;
    outward += outward_[around[i]];
  }
  const auto area = [&](size_t a, size_t b, size_t c) { return outward.dot((at[b] - at[a]).cross(at[c] - at[a])); };
  return std::min(area(1, 2, 3), area(1, 3, 0)) > std::min(area(0, 1, 2), area(0, 2, 3));
}

/// The component of a node in a cut cell.
uint8_t WoundWalls::sideOf(uint32_t cell, uint32_t node) const {
  const CutCell& cut = *cells_->find(cell);
  return cut.component[static_cast<size_t>(cut.cornerOf(node))];
}

/// Every lip with its cell's point, and where a lip goes on in another cell both cells' points with the vertex between.
void WoundWalls::addFans() {
  const auto point_of = [&](const Lip& lip) { return pointVertex(lip.cell, sideOf(lip.cell, lip.node)); };
  const auto key = [&](const Lip& lip, uint32_t vertex) {
    const bool on_edge =
        skin_->edgeOf(vertex) != WoundSkin::kNoEdge;  // it goes on in the triangle beside, else within its own
    return uint64_t{on_edge ? UINT32_MAX : lip.triangle} << 32U | vertex;
  };
  const std::vector<Lip>& lips = skin_->lips();
  for (uint32_t i = 0; i < lips.size(); ++i) {
    if (lips[i].cell == Lip::kNoCell) continue;
    const uint32_t to = lipVertex(lips[i].to), from = lipVertex(lips[i].from);
    add(to, from, point_of(lips[i]));
    outward_[to] += lips[i].outward;
    outward_[from] += lips[i].outward;
    lip_ends_.push_back({key(lips[i], lips[i].to), i});
  }
  std::sort(lip_ends_.begin(), lip_ends_.end());
  for (const Lip& lip : lips) {
    if (lip.cell == Lip::kNoCell) continue;
    const LipEnd begin = {key(lip, lip.from), 0};
    const auto found = std::lower_bound(lip_ends_.begin(), lip_ends_.end(), begin);
    if (found == lip_ends_.end() || found->key != begin.key) continue;
    const uint32_t before = point_of(lips[found->lip]), behind = point_of(lip);
    // Not from side to side of one cell, where a wound ends: a web would span it when it opens.
    if (cell_of_[before] != cell_of_[behind]) add(lipVertex(lip.from), before, behind);
  }
}

void WoundWalls::findNormals() {
  for (size_t t = 0; t < triangles_.size(); t += 3) {
    std::array<WoundVertex*, 3> v = {&vertices_[triangles_[t]], &vertices_[triangles_[t + 1]],
                                     &vertices_[triangles_[t + 2]]};
    const Vector3d normal = (v[1]->point - v[0]->point).cross(v[2]->point - v[0]->point);
    for (WoundVertex* vertex : v) vertex->normal += normal;
  }
  for (WoundVertex& vertex : vertices_)
    vertex.normal =
        vertex.normal.squaredNorm() > 0 ? Vector3d(vertex.normal.stableNormalized()) : Vector3d(Vector3d::UnitZ());
}

void WoundWalls::begin() {
  triangles_.clear();
  vertices_.clear();
  cell_of_.clear();
  outward_.clear();
  lip_ends_.clear();
  const size_t cells = cells_->cells().size(), skin_vertices = skin_->own() + skin_->added().size();
  keepRoom(points_, cells);
  keepRoom(point_vertices_, 8 * cells);
  keepRoom(lip_vertices_, skin_vertices);
  points_.assign(cells, {});
  point_vertices_.assign(8 * cells, kNone);
  lip_vertices_.assign(skin_vertices, kNone);
  holes_ = 0;
}

void WoundWalls::update(const CutCells& cells, const WoundSkin& skin) {
  cells_ = &cells;
  skin_ = &skin;
  begin();
  findPoints();
  addQuads();
  addFans();
  closeHoles();
  relax();
  findNormals();
}

}  // namespace viscera
