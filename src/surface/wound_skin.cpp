// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wound_skin.h"

#include <algorithm>
#include <unordered_map>

namespace viscera {

namespace {

// In cells.
constexpr double kStep = 0.125;  // an edge is looked at this finely, so that a wedge thinner than it may be passed over
constexpr double kFine = 1e-4;   // and a crossing is found to this
constexpr double kBeside = 0.02;  // how far from a lip its side is asked for where no node of it says so

uint64_t pairOf(uint32_t a, uint32_t b) {
  return uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

}  // namespace

WoundSkin::WoundSkin(const Skin& skin, const Lattice& lattice)
    : skin_(skin), own_(static_cast<uint32_t>(skin.bindings.size())) {
  for (const Vector3f& at : skin.mesh.positions_m) {
    points_.push_back((at.cast<double>() - lattice.origin_m) / lattice.spacing_m);
  }
  normals_ = vertexNormals(skin.mesh);
  const CutCells whole(lattice);
  std::unordered_map<uint64_t, uint32_t> numbers;
  touched_starts_.push_back(0);
  for (const std::array<uint32_t, 3>& corners : skin.mesh.triangles) {
    std::array<uint32_t, 3> edges{};
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = corners[i], b = corners[(i + 1) % 3];
      const auto [at, fresh] = numbers.try_emplace(pairOf(a, b), static_cast<uint32_t>(edges_.size()));
      if (fresh) edges_.push_back({std::min(a, b), std::max(a, b)});
      edges[i] = at->second;
    }
    triangle_edges_.push_back(edges);
    const Vector3d &a = points_[corners[0]], &b = points_[corners[1]], &c = points_[corners[2]];
    for (const Vector3d& at :
         {a, b, c, Vector3d((a + b) / 2), Vector3d((b + c) / 2), Vector3d((c + a) / 2), Vector3d((a + b + c) / 3)}) {
      const uint32_t cell = whole.placeOf(at).cell;
      if (std::find(touched_.begin() + touched_starts_.back(), touched_.end(), cell) == touched_.end())
        touched_.push_back(cell);
    }
    touched_starts_.push_back(static_cast<uint32_t>(touched_.size()));
  }
  for (const Vector3d& point : points_) places_.push_back(whole.placeOf(point));
  copies_.assign(edges_.size(), kNoEdge);
  for (uint32_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    triangles_.insert(triangles_.end(), skin.mesh.triangles[t].begin(), skin.mesh.triangles[t].end());
    sources_.push_back(t);
  }
}

void WoundSkin::findPlaces(const CutCells& cells) {
  rebound_.clear();
  for (uint32_t v = 0; v < own_; ++v) {
    const layout::SkinBinding& binding = skin_.bindings[v];
    const bool near = cells.find(places_[v].cell) != nullptr;
    if (near) places_[v] = cells.placeOf(points_[v]);
    const bool torn = !cells.isAlive(binding.slot0, binding.springs & 31U) ||
                      !cells.isAlive(binding.slot2, binding.springs >> 10U & 31U);
    if (near || torn) rebound_.push_back({v, {points_[v], normals_[v].cast<double>(), places_[v], v}});
  }
}

void WoundSkin::findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPlace& from, double last,
                          const WoundPlace& to, std::vector<Step>& out) const {
  const Vector3d &a = points_[edges_[edge][0]], &b = points_[edges_[edge][1]];
  const double length = (last - first) * (b - a).norm();
  if (from.node == to.node && length <= kStep) return;
  if (length <= kFine) {
    if (cells.areParted(from.node, to.node)) out.push_back({first, last, from, to});
    return;
  }
  const double middle = (first + last) / 2;
  const WoundPlace at = cells.placeOf(a + middle * (b - a));
  findSteps(cells, edge, first, from, middle, at, out);
  findSteps(cells, edge, middle, at, last, to, out);
}

void WoundSkin::splitEdge(const CutCells& cells, uint32_t edge) {
  const auto [a, b] = edges_[edge];
  std::vector<Step> steps;
  findSteps(cells, edge, 0, places_[a], 1, places_[b], steps);
  if (steps.empty()) return;
  if (steps.size() > 1) {
    const uint32_t from = steps.front().from.node, to = steps.back().to.node;
    const Vector3i apart = cells.lattice().nodeAt(from) - cells.lattice().nodeAt(to);
    if (from == to || (apart.cwiseAbs().maxCoeff() <= 1 && !cells.areParted(from, to))) return;  // in and out again
    ++slivers_;
  }
  const double share_a = (steps.front().before + steps.front().behind) / 2,
               share_b = (steps.back().before + steps.back().behind) / 2;
  copies_[edge] = own_ + static_cast<uint32_t>(added_.size());
  const auto add = [&](double share, const WoundPlace& place, uint32_t like) {
    const Vector3d normal = (1 - share) * normals_[a].cast<double>() + share * normals_[b].cast<double>();
    added_.push_back({points_[a] + share * (points_[b] - points_[a]), normal.stableNormalized(), place, like});
    edge_of_.push_back(edge);
  };
  add(share_a, steps.front().from, a);
  add(share_b, steps.back().to, b);
}

uint32_t WoundSkin::copyAt(uint32_t edge, uint32_t vertex) const {
  return copies_[edge] + (edges_[edge][0] == vertex ? 0 : 1);
}

void WoundSkin::addPiece(const CutCells& cells, uint32_t triangle, std::initializer_list<uint32_t> vertices) {
  const uint32_t* const v = vertices.begin();
  if (!isShown(cells, v[0])) return;
  for (size_t i = 2; i < vertices.size(); ++i) {
    triangles_.insert(triangles_.end(), {v[0], v[i - 1], v[i]});
    sources_.push_back(triangle);
  }
}

void WoundSkin::addLip(const CutCells& cells, uint32_t triangle, uint32_t from, uint32_t to, uint32_t corner) {
  if (!isShown(cells, corner)) return;
  const Vector3d middle = (pointOf(from) + pointOf(to)) / 2;
  const CutCell* cell = cells.find(cells.placeOf(middle).cell);
  for (const uint32_t end : {from, to}) {
    if (cell == nullptr) cell = cells.find(placeOf(end).cell);
  }
  lips_.push_back({from, to, triangle});
  if (cell == nullptr) return;
  Lip& lip = lips_.back();
  lip.cell = static_cast<uint32_t>(cells.slotAt(cell->at));
  const bool from_split = from >= own_, to_split = to >= own_;
  if (from_split && cell->holds(placeOf(from).node)) {
    lip.node = placeOf(from).node;
  } else if (to_split && cell->holds(placeOf(to).node)) {
    lip.node = placeOf(to).node;
  } else {
    const Vector3d beside = middle + kBeside * (pointOf(corner) - middle).stableNormalized();
    const Vector3d within = (beside - cell->at.cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
    lip.node = cell->slots[static_cast<size_t>(cell->cornerAt(within.cast<float>()))];
  }
}

void WoundSkin::showTapered(const CutCells& cells, uint32_t triangle, uint32_t first) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const uint32_t v = corners[first], w = corners[(first + 1) % 3], tip = corners[(first + 2) % 3];
  const uint32_t edge = triangle_edges_[triangle][first], of_v = copyAt(edge, v), of_w = copyAt(edge, w);
  addPiece(cells, triangle, {v, of_v, tip});
  addLip(cells, triangle, of_v, tip, v);
  addPiece(cells, triangle, {w, tip, of_w});
  addLip(cells, triangle, tip, of_w, w);
}

void WoundSkin::showParted(const CutCells& cells, uint32_t triangle, uint32_t corner) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const auto& edges = triangle_edges_[triangle];
  const uint32_t a = corners[corner], b = corners[(corner + 1) % 3], c = corners[(corner + 2) % 3];
  const uint32_t ab = edges[corner], ca = edges[(corner + 2) % 3];
  addPiece(cells, triangle, {a, copyAt(ab, a), copyAt(ca, a)});
  addLip(cells, triangle, copyAt(ab, a), copyAt(ca, a), a);
  addPiece(cells, triangle, {b, c, copyAt(ca, c), copyAt(ab, b)});
  addLip(cells, triangle, copyAt(ca, c), copyAt(ab, b), b);
}

void WoundSkin::showStar(const CutCells& cells, uint32_t triangle) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const auto& edges = triangle_edges_[triangle];
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
  for (size_t i = 0; i < 3; ++i) {
    middle += (pointOf(copyAt(edges[i], corners[i])) + pointOf(copyAt(edges[i], corners[(i + 1) % 3]))) / 6;
    normal += normals_[corners[i]].cast<double>();
  }
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t a = corners[i], to_next = copyAt(edges[i], a), to_last = copyAt(edges[(i + 2) % 3], a);
    const auto centre = own_ + static_cast<uint32_t>(added_.size());
    added_.push_back({middle, normal.stableNormalized(), placeOf(to_next), a});
    edge_of_.push_back(kNoEdge);
    addPiece(cells, triangle, {a, to_next, centre, to_last});
    addLip(cells, triangle, to_next, centre, a);
    addLip(cells, triangle, centre, to_last, a);
  }
}

void WoundSkin::show(const CutCells& cells, uint32_t triangle) {
  const auto& corners = skin_.mesh.triangles[triangle];
  uint32_t crossed = 0, count = 0, whole = 0, split = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const bool is_split = copies_[triangle_edges_[triangle][i]] != kNoEdge;
    count += is_split ? 1 : 0;
    (is_split ? split : whole) = i;
    crossed |= (is_split ? 1U : 0U) << i;
  }
  if (count == 0) addPiece(cells, triangle, {corners[0], corners[1], corners[2]});
  if (count == 1) showTapered(cells, triangle, split);
  if (count == 2) showParted(cells, triangle, (whole + 2) % 3);  // the corner across the whole edge
  if (count == 3) showStar(cells, triangle);
}

void WoundSkin::update(const CutCells& cells) {
  added_.clear();
  edge_of_.clear();
  lips_.clear();
  triangles_.clear();
  sources_.clear();
  slivers_ = 0;
  std::fill(copies_.begin(), copies_.end(), kNoEdge);
  findPlaces(cells);
  std::vector<bool> seen(edges_.size());
  for (uint32_t t = 0; t < triangle_edges_.size(); ++t) {
    bool near = false;
    for (uint32_t i = touched_starts_[t]; i < touched_starts_[t + 1]; ++i)
      near = near || cells.find(touched_[i]) != nullptr;
    if (!near) continue;
    for (const uint32_t edge : triangle_edges_[t]) {
      if (!seen[edge]) splitEdge(cells, edge);
      seen[edge] = true;
    }
  }
  for (uint32_t t = 0; t < triangle_edges_.size(); ++t) show(cells, t);
}

}  // namespace viscera
