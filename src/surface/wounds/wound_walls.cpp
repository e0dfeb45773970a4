// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_walls.h"

#include <algorithm>
#include <array>

#include "surface/skins/keep_room.h"

namespace viscera {

namespace {

constexpr uint32_t kNone = WoundMesh::kNone;

/// Returns the number of the cut cell there, or kNone.
uint32_t cellAt(const CutCells& cells, const Vector3i& at) {
  const int64_t lowest = cells.slotAt(at);
  if (lowest < 0 || cells.find(static_cast<uint32_t>(lowest)) == nullptr) return kNone;
  return cells.numberOf(static_cast<uint32_t>(lowest));
}

/// Returns the four cells around the spring from a cell's lowest corner along an axis, counter-clockwise from its far
/// end.
std::array<Vector3i, 4> cellsAround(const Vector3i& at, int axis) {
  const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
  return {at, at - u, at - u - v, at - v};
}

/// Returns the direction across the wound from the side of a component: the sum of its cut edges.
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

void WoundWalls::Seen::record(uint32_t i, uint32_t mark) {
  if (i >= marks.size()) {
    keepRoom(marks, i + 1);
    marks.resize(i + 1);
  }
  if (marks[i] == mark) return;
  marks[i] = mark;
  appendTo(list, i);
}

uint32_t WoundWalls::newVertex(const WoundVertex& vertex, uint32_t cell) {
  if (free_vertices_.empty()) {
    appendTo(free_vertices_, static_cast<uint32_t>(vertices_.size()));
    appendTo(vertices_, vertex);
    appendTo(cell_of_, cell);
    appendTo(outward_, Vector3d(Vector3d::Zero()));
  }
  const uint32_t number = free_vertices_.back();
  free_vertices_.pop_back();
  vertices_[number] = vertex;
  cell_of_[number] = cell;
  outward_[number] = Vector3d::Zero();
  to_shade_.record(number, mark_);
  return number;
}

/// Finds the node and the outward direction from it for a point's vertex. @returns whether that has changed
bool WoundWalls::place(uint32_t v, const CutCell& cut, uint8_t component) {
  WoundVertex& vertex = vertices_[v];
  const Vector3d point = firstPosition(v);
  const WoundPoint before = vertex.position;
  vertex.position = {cut.slots[0], Vector3f::Zero(), 0};
  double nearest = -1;
  for (size_t c = 0; c < 8; ++c) {
    if (cut.component[c] != component) continue;
    const double distance2 = (point - cells_->lattice().nodeAt(cut.slots[c]).cast<double>()).squaredNorm();
    if (nearest >= 0 && distance2 >= nearest) continue;
    nearest = distance2;
    vertex.position.node = cut.slots[c];
  }
  const Vector3d outward = outwardOf(cut, component);
  const bool same =
      before.cell == vertex.position.cell && before.node == vertex.position.node && outward == outward_[v];
  outward_[v] = outward;
  return !same;
}

uint32_t WoundWalls::pointVertex(uint32_t cell, uint8_t component) {
  uint32_t& known = point_vertices_[8 * size_t{cell} + component];
  if (known != kNone) return known;
  WoundVertex vertex;
  vertex.point = points_[cell].at[0];
  known = newVertex(vertex, cell);
  place(known, cells_->cells()[cell], component);
  askAlways(cell);
  return known;
}

uint32_t WoundWalls::lipVertex(uint32_t skin_vertex) {
  uint32_t& known = lip_vertices_[skin_vertex - skin_->ownCount()];
  if (known == kNone) known = newVertex({skin_->pointOf(skin_vertex), Vector3d::Zero(), {}, skin_vertex}, kNone);
  return known;
}

/// Returns the place of a vertex before points are relaxed.
Vector3d WoundWalls::firstPosition(uint32_t vertex) const {
  const uint32_t cell = cell_of_[vertex];
  return cell == kNone ? vertices_[vertex].point : points_[cell].at[0];
}

/// Notes what depends on a triangle's corners.
void WoundWalls::recordCorners(uint32_t triangle) {
  for (const uint32_t vertex : mesh_.cornersOf(triangle)) {
    to_shade_.record(vertex, mark_);
    if (cell_of_[vertex] != kNone) askAlways(cell_of_[vertex]);
  }
}

void WoundWalls::dropTriangle(uint32_t& known) {
  if (known == kNone) return;
  recordCorners(known);
  for (const uint32_t vertex : mesh_.cornersOf(known)) touched_.record(vertex, mark_);
  mesh_.remove(known);
  known = kNone;
}

/// Sets a triangle of a quad or fan. @param known  the old one; becomes the new one, unless two corners are equal
void WoundWalls::setTriangle(const std::array<uint32_t, 3>& corners, uint64_t order, uint32_t& known) {
  if (known != kNone && mesh_.isThis(known, corners, order)) return;
  dropTriangle(known);
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  known = mesh_.add(corners, order);
  recordCorners(known);
  for (const uint32_t vertex : corners) touched_.record(vertex, mark_);
}

/// Returns whether the spring from a node along an axis crosses the wound inside the tissue. At the end of the lattice
/// the surface mesh does.
bool WoundWalls::isInside(uint32_t slot, int axis) const {
  const Lattice& lattice = cells_->lattice();
  const Vector3i at = lattice.nodeAt(slot);
  for (const Vector3i& around : cellsAround(at, axis)) {
    if (cellAt(*cells_, around) == kNone) return false;
  }
  if (lattice.depth_m.empty()) return true;
  const int edge = 4 * axis;  // of the cell that begins there
  const float share = cells_->find(slot)->crossed[static_cast<size_t>(edge)];
  const auto far = static_cast<size_t>(cells_->slotAt(at + Vector3i::Unit(axis)));
  return (1 - share) * lattice.depth_m[slot] + share * lattice.depth_m[far] > 0;
}

/// Computes a cell's point, the mean of the cuts of springs inside the tissue and of the surface mesh.
void WoundWalls::findPoint(uint32_t number) {
  const CutCell& cell = cells_->cells()[number];
  Vector3d sum = Vector3d::Zero();
  uint32_t marks = 0;
  for (int e = 0; e < 12; ++e) {
    if ((cell.cut >> e & 1U) == 0) continue;
    const int axis = e / 4;
    const uint32_t slot = cell.slots[static_cast<size_t>(edgeCorners(e)[0])];
    if (!isInside(slot, axis)) continue;
    Vector3d at = cells_->lattice().nodeAt(slot).cast<double>();
    at[axis] += static_cast<double>(cell.crossed[static_cast<size_t>(e)]);
    sum += at;
    ++marks;
  }
  cell_lips_.clear();
  for (uint32_t f = first_fans_[number]; f != kNone; f = fans_[f].next)
    appendTo(cell_lips_, std::make_pair(8 * uint64_t{fans_[f].triangle} + f % 6, f));
  std::sort(cell_lips_.begin(), cell_lips_.end());
  for (const auto& [order, f] : cell_lips_) {
    sum += (vertices_[fans_[f].from].point + vertices_[fans_[f].to].point) / 2;
    ++marks;
  }
  if (marks > 0)
    sum /= marks;
  else
    sum = cell.at.cast<double>() + cell.centre.cast<double>();
  Point& point = points_[number];
  const bool moved = point.at[0] != sum || point.marks != marks || point.order != cell.order;
  point.at[0] = sum;
  point.marks = marks;
  point.order = cell.order;
  if (moved) {
    cells_changed_.record(number, mark_);
    askAlways(number);
  }
  for (uint8_t component = 0; component < 8; ++component) {
    const uint32_t vertex = point_vertices_[8 * size_t{number} + component];
    if (vertex == kNone || (!place(vertex, cell, component) && !moved)) continue;
    touched_.record(vertex, mark_);
    to_bind_.record(vertex, mark_);
    askAround(vertex);
  }
}

/// Computes the points of cells in which springs or lips have changed.
void WoundWalls::findPoints() {
  for (const uint32_t lowest : cells_->changedCells()) {
    if (cells_->numberOf(lowest) != kNone) cells_changed_.record(cells_->numberOf(lowest), mark_);
    const Vector3i at = cells_->lattice().nodeAt(lowest);
    for (int i = 0; i < 27; ++i) {
      const uint32_t cell = cellAt(*cells_, at + Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      if (cell != kNone) points_to_find_.record(cell, mark_);
    }
  }
  for (const uint32_t cell : cells_changed_.list) {
    for (size_t component = 0; component < 8; ++component) {
      const uint32_t vertex = point_vertices_[8 * size_t{cell} + component];
      if (vertex != kNone) to_bind_.record(vertex, mark_);
    }
  }
  for (const uint32_t cell : points_to_find_.list) {
    if (cells_->cells()[cell].cut != 0) findPoint(cell);
  }
}

void WoundWalls::addQuad(uint32_t number, int axis) {
  const CutCell& cell = cells_->cells()[number];
  std::array<std::array<uint32_t, 3>, 4> now{};  // without area: no triangle
  if ((cell.cut >> (4 * axis) & 1U) != 0 && isInside(cell.slots[0], axis)) {
    const uint32_t low = cell.slots[0];
    const auto high = static_cast<uint32_t>(cells_->slotAt(cell.at + Vector3i::Unit(axis)));
    std::array<uint32_t, 4> of_low{}, of_high{};
    for (size_t i = 0; i < 4; ++i) {
      const uint32_t around = cellAt(*cells_, cellsAround(cell.at, axis)[i]);
      of_low[i] = pointVertex(around, sideOf(around, low));
      of_high[i] = pointVertex(around, sideOf(around, high));
    }
    if (of_low != of_high) {  // else the cut ends around it: its sides are one
      const size_t first = isBetterAcross(of_low) ? 1 : 0;
      const auto quad = [&](const std::array<uint32_t, 4>& around, size_t at) {
        now[at] = {around[first], around[first + 1], around[first + 2]};
        now[at + 1] = {around[first], around[first + 2], around[(first + 3) % 4]};
      };
      if (!cells_->isGone(low)) quad(of_low, 0);
      if (!cells_->isGone(high)) quad({of_high[0], of_high[3], of_high[2], of_high[1]}, 2);
    }
  }
  for (size_t i = 0; i < 4; ++i) {
    const size_t position = 4 * static_cast<size_t>(axis) + i;
    setTriangle(now[i], cell.order << 4U | position, quads_[number][position]);
  }
}

/// Adds quads around springs next to changed cells.
void WoundWalls::addQuads() {
  for (const uint32_t number : cells_changed_.list) {
    const Vector3i at = cells_->cells()[number].at;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
      for (const Vector3i& from : {at, Vector3i(at + u), Vector3i(at + v), Vector3i(at + u + v)}) {
        const int64_t lowest = cells_->slotAt(from);
        const uint32_t cell = lowest < 0 ? kNone : cells_->numberOf(static_cast<uint32_t>(lowest));
        if (cell != kNone) quads_to_make_.record(3 * cell + axis, mark_);
      }
    }
  }
  for (const uint32_t quad : quads_to_make_.list) addQuad(quad / 3, static_cast<int>(quad % 3));
}

/// Returns whether the triangles of a quad have a better shape with the diagonal from its second corner.
bool WoundWalls::isBetterAcross(const std::array<uint32_t, 4>& around) const {
  std::array<Vector3d, 4> at;
  Vector3d outward = Vector3d::Zero();
  for (size_t i = 0; i < 4; ++i) {
    at[i] = firstPosition(around[i]);
    outward += outward_[around[i]];
  }
  const auto area = [&](size_t a, size_t b, size_t c) { return outward.dot((at[b] - at[a]).cross(at[c] - at[a])); };
  return std::min(area(1, 2, 3), area(1, 3, 0)) > std::min(area(0, 1, 2), area(0, 2, 3));
}

/// Returns the component of a node in a cut cell.
uint8_t WoundWalls::sideOf(uint32_t cell, uint32_t node) const {
  const CutCell& cut = cells_->cells()[cell];
  return cut.component[static_cast<size_t>(cut.cornerOf(node))];
}

void WoundWalls::clear() {
  mesh_.clear();
  vertices_.clear();
  cell_of_.clear();
  outward_.clear();
  points_.clear();
  quads_.clear();
  fans_.clear();
  for (std::vector<uint32_t>* list : {&point_vertices_, &first_fans_, &lip_vertices_, &free_vertices_, &hole_ends_})
    list->clear();
}

/// Reserves memory for the current number of cells and lips.
void WoundWalls::makeRoom() {
  const auto room = [](auto& list, size_t count, const auto& with) {
    keepRoom(list, count);
    if (list.size() < count) list.resize(count, with);
  };
  constexpr std::array<uint32_t, 12> kNoQuads = {kNone, kNone, kNone, kNone, kNone, kNone,
                                                 kNone, kNone, kNone, kNone, kNone, kNone};
  const size_t cells = cells_->cells().size();
  room(points_, cells, Point());
  room(point_vertices_, 8 * cells, kNone);
  room(quads_, cells, kNoQuads);
  room(first_fans_, cells, kNone);
  room(fans_, 6 * skin_->shown().size(), Fan());
  room(lip_vertices_, skin_->added().size(), kNone);
  for (std::vector<uint32_t>& marks : asked_marks_) room(marks, cells, 0U);
}

void WoundWalls::update(const CutCells& cells, const WoundSkin& skin) {
  cells_ = &cells;
  skin_ = &skin;
  changed_.clear();
  points_tried_ = 0;
  if (cells.isWhole()) return clear();
  ++mark_;
  for (Seen* seen : {&fans_to_make_, &quads_to_make_, &points_to_find_, &cells_changed_, &touched_, &around_hole_,
                     &to_shade_, &to_bind_})
    seen->list.clear();
  makeRoom();
  takeFans();
  findPoints();
  addQuads();
  addFans();
  closeHoles();
  relax();
  findNormals();
  for (const uint32_t vertex : to_bind_.list) appendTo(changed_, vertex);
}

}  // namespace viscera
