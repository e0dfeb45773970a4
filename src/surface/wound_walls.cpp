// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wound_walls.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

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

}  // namespace

uint32_t WoundWalls::pointVertex(uint32_t cell, uint8_t component) {
  const auto [at, fresh] =
      point_vertices_.try_emplace(uint64_t{cell} << 8U | component, static_cast<uint32_t>(vertices_.size()));
  if (!fresh) return at->second;
  const CutCell& cut = *cells_->find(cell);
  const auto point = points_.find(cell);
  WoundVertex vertex;
  vertex.point = point != points_.end() ? point->second : Vector3d(cut.at.cast<double>() + cut.centre.cast<double>());
  vertex.place = {cell, Vector3f::Zero(), 0};
  double nearest = -1;
  for (size_t c = 0; c < 8; ++c) {
    if (cut.component[c] != component) continue;
    const double distance2 = (vertex.point - cells_->lattice().nodeAt(cut.slots[c]).cast<double>()).squaredNorm();
    if (nearest >= 0 && distance2 >= nearest) continue;
    nearest = distance2;
    vertex.place.node = cut.slots[c];
  }
  vertices_.push_back(vertex);
  return at->second;
}

uint32_t WoundWalls::lipVertex(uint32_t skin_vertex) {
  const auto [at, fresh] = lip_vertices_.try_emplace(skin_vertex, static_cast<uint32_t>(vertices_.size()));
  if (fresh) vertices_.push_back({skin_->pointOf(skin_vertex), Vector3d::Zero(), {}, skin_vertex});
  return at->second;
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
  std::unordered_map<uint32_t, double> counts;
  const auto note = [&](uint32_t cell, const Vector3d& at) {
    const auto [sum, fresh] = points_.try_emplace(cell, Vector3d::Zero());
    sum->second += at;
    counts[cell] += 1;
  };
  for (const CutCell& cell : cells_->cells()) {
    for (int e = 0; e < 12; ++e) {
      if ((cell.cut >> e & 1U) == 0) continue;
      const int axis = e / 4;
      const uint32_t slot = cell.slots[static_cast<size_t>(edgeCorners(e)[0])];
      if (!isInside(slot, axis)) continue;
      Vector3d at = cells_->lattice().nodeAt(slot).cast<double>();
      at[axis] += static_cast<double>(cell.crossed[static_cast<size_t>(e)]);
      note(cell.slots[0], at);
    }
  }
  for (const Lip& lip : skin_->lips()) {
    if (lip.cell != Lip::kNoCell) note(lip.cell, (skin_->pointOf(lip.from) + skin_->pointOf(lip.to)) / 2);
  }
  for (auto& [cell, sum] : points_) sum /= counts[cell];
}

void WoundWalls::addQuads() {
  for (const CutCell& cell : cells_->cells()) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((cell.cut >> (4 * axis) & 1U) == 0 || !isInside(cell.slots[0], axis)) continue;
      const uint32_t low = cell.slots[0];
      const auto high = static_cast<uint32_t>(cells_->slotAt(cell.at + Vector3i::Unit(axis)));
      std::array<uint32_t, 4> around{}, of_low{}, of_high{};
      for (size_t i = 0; i < 4; ++i) {
        around[i] = static_cast<uint32_t>(cellAt(*cells_, cellsAround(cell.at, axis)[i]));
        const CutCell& cut = *cells_->find(around[i]);
        of_low[i] = pointVertex(around[i], cut.component[static_cast<size_t>(cut.cornerOf(low))]);
        of_high[i] = pointVertex(around[i], cut.component[static_cast<size_t>(cut.cornerOf(high))]);
      }
      if (of_low == of_high) continue;  // the cut ends around it: its sides are one
      if (!cells_->isGone(low)) {
        add(of_low[0], of_low[1], of_low[2]);
        add(of_low[0], of_low[2], of_low[3]);
      }
      if (!cells_->isGone(high)) {
        add(of_high[0], of_high[2], of_high[1]);
        add(of_high[0], of_high[3], of_high[2]);
      }
    }
  }
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
  std::unordered_map<uint64_t, const Lip*> ends;
  for (const Lip& lip : skin_->lips()) {
    if (lip.cell == Lip::kNoCell) continue;
    add(lipVertex(lip.to), lipVertex(lip.from), point_of(lip));
    ends[key(lip, lip.to)] = &lip;
  }
  for (const Lip& lip : skin_->lips()) {
    const auto found = ends.find(key(lip, lip.from));
    if (lip.cell == Lip::kNoCell || found == ends.end()) continue;
    add(lipVertex(lip.from), point_of(*found->second), point_of(lip));
  }
}

/// What is still open: where lips step from cell to cell across an edge of the lattice, where they end before the cut
/// inside does. Such holes are rings of a few edges between points of neighbouring cells.
void WoundWalls::closeHoles() {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;  // lower vertex first: times that way, less times the other
  const auto note = [&](uint32_t a, uint32_t b) { a < b ? ++edges[{a, b}] : --edges[{b, a}]; };
  for (size_t t = 0; t < triangles_.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) note(triangles_[t + i], triangles_[t + (i + 1) % 3]);
  }
  for (const Lip& lip : skin_->lips()) note(lipVertex(lip.from), lipVertex(lip.to));
  std::multimap<uint32_t, uint32_t> open;
  for (const auto& [edge, sum] : edges) {
    for (int i = 0; i < std::abs(sum); ++i) open.insert(sum > 0 ? edge : std::make_pair(edge.second, edge.first));
  }
  while (!open.empty()) {
    std::vector<uint32_t> way = {open.begin()->first};
    while (true) {
      const auto next = open.find(way.back());
      if (next == open.end()) {  // at a border of the skin: nothing closes there
        ++holes_;
        break;
      }
      const uint32_t vertex = next->second;
      open.erase(next);
      const auto met = std::find(way.begin(), way.end(), vertex);
      if (met != way.end()) {
        closeRing({met, way.end()});
        way.erase(met + 1, way.end());
        if (way.size() == 1) break;
      } else {
        way.push_back(vertex);
      }
    }
  }
}

/// A fan from the ring's least point, so that the two sides of a wound are filled alike; but not from one that the
/// other side has in the ring as well, which would span a web from lip to lip.
void WoundWalls::closeRing(std::vector<uint32_t> ring) {
  const auto point = [&](uint32_t vertex) -> const Vector3d& { return vertices_[vertex].point; };
  const auto has_twin = [&](uint32_t vertex) {
    return std::count_if(ring.begin(), ring.end(), [&](uint32_t v) { return point(v) == point(vertex); }) > 1;
  };
  const auto before = [&](uint32_t a, uint32_t b) {
    const bool twin_a = has_twin(a), twin_b = has_twin(b);
    if (twin_a != twin_b) return twin_b;
    return std::lexicographical_compare(point(a).data(), point(a).data() + 3, point(b).data(), point(b).data() + 3);
  };
  const auto first = std::min_element(ring.begin(), ring.end(), before);
  std::rotate(ring.begin(), first, ring.end());
  for (size_t i = 2; i < ring.size(); ++i) add(ring[0], ring[i], ring[i - 1]);
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

void WoundWalls::update(const CutCells& cells, const WoundSkin& skin) {
  cells_ = &cells;
  skin_ = &skin;
  triangles_.clear();
  vertices_.clear();
  points_.clear();
  point_vertices_.clear();
  lip_vertices_.clear();
  holes_ = 0;
  findPoints();
  addQuads();
  addFans();
  closeHoles();
  findNormals();
}

}  // namespace viscera
