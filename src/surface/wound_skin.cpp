// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wound_skin.h"

#include <algorithm>
#include <array>
#include <limits>

namespace viscera {

namespace {

// In cells.
constexpr double kStep = 0.125;  // an edge is looked at this finely, so that a wedge thinner than it may be passed over
constexpr double kFine = 1e-4;   // and a crossing is found to this
constexpr double kLeastPiece =
    0.05;  // an edge is not crossed nearer to its end: what is thinner turns over when pulled
constexpr double kLeastShare = 0.25;  // but as far as this of a short edge
constexpr double kOfTheWay = 0.6;     // on which a wound goes through the triangle in which it ends
constexpr double kOtherwise = 0.25;   // of the way to the third corner, which leads away from the blade's path
constexpr double kLeastAlong = 0.05;  // of its longest share: a way less away from the edge is not to be trusted
constexpr double kBeside = 0.02;      // how far from a lip its side is asked for where no node of it says so

}  // namespace

WoundSkin::WoundSkin(const Skin& skin, const Lattice& lattice)
    : skin_(skin), index_(skin, lattice), own_(static_cast<uint32_t>(skin.bindings.size())), places_(index_.places) {
  seen_triangles_.marks.resize(skin.mesh.triangles.size());
  seen_vertices_.marks.resize(own_);
  seen_edges_.marks.resize(index_.edges.size());
  copies_.assign(index_.edges.size(), kNoEdge);
  for (uint32_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    triangles_.insert(triangles_.end(), skin.mesh.triangles[t].begin(), skin.mesh.triangles[t].end());
    sources_.push_back(t);
  }
}

/// The skin is whole again.
void WoundSkin::forget() {
  for (const auto& [vertex, how] : rebound_) places_[vertex] = index_.places[vertex];
  for (const uint32_t edge : crossed_) copies_[edge] = kNoEdge;
  triangles_.resize(3 * index_.triangle_edges.size());
  sources_.resize(index_.triangle_edges.size());
  for (const uint32_t t : replaced_) setTriangle(t, t, skin_.mesh.triangles[t].data());
  for (auto* list : {&near_, &gone_, &crossed_, &replaced_, &gaps_, &edge_of_}) list->clear();
  is_end_.clear();
  rebound_.clear();
  added_.clear();
  lips_.clear();
  slivers_ = 0;
  ++mark_;
}

void WoundSkin::findNear(const CutCells& cells) {
  for (const CutCell& cell : cells.cells()) {
    index_.of_cells.forEach(cell.slots[0], [&](uint32_t triangle) {
      if (seen_triangles_.first(triangle, mark_)) near_.push_back(triangle);
    });
  }
  std::sort(near_.begin(), near_.end());
}

void WoundSkin::findGone(const CutCells& cells) {
  for (const uint32_t slot : cells.severed()) {
    if (!cells.isGone(slot)) continue;
    const Vector3i node = cells.lattice().nodeAt(slot);
    for (int c = 0; c < 8; ++c) {
      const int64_t lowest = cells.slotAt(node - Vector3i(c & 1, c >> 1 & 1, c >> 2));
      if (lowest < 0) continue;
      index_.of_cells.forEach(static_cast<uint32_t>(lowest), [&](uint32_t triangle) {
        if (seen_triangles_.first(triangle, mark_)) gone_.push_back(triangle);
      });
    }
  }
}

void WoundSkin::findPlaces(const CutCells& cells) {
  const auto rebind = [&](uint32_t v) {
    rebound_.push_back({v, {index_.points[v], index_.normals[v].cast<double>(), places_[v], v}});
  };
  for (const uint32_t t : near_) {
    for (const uint32_t v : skin_.mesh.triangles[t]) {
      if (cells.find(places_[v].cell) == nullptr || !seen_vertices_.first(v, mark_)) continue;
      places_[v] = cells.placeOf(index_.points[v]);
      rebind(v);
    }
  }
  for (const uint32_t slot : cells.severed()) {
    index_.of_slots.forEach(slot, [&](uint32_t v) {
      const layout::SkinBinding& binding = skin_.bindings[v];
      const bool torn = !cells.isAlive(binding.slot0, binding.springs & 31U) ||
                        !cells.isAlive(binding.slot2, binding.springs >> 10U & 31U);
      if (torn && seen_vertices_.first(v, mark_)) rebind(v);
    });
  }
}

void WoundSkin::findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPlace& from, double last,
                          const WoundPlace& to) {
  const Vector3d &a = index_.points[index_.edges[edge][0]], &b = index_.points[index_.edges[edge][1]];
  const double length = (last - first) * (b - a).norm();
  if (from.node == to.node && length <= kStep) return;
  if (length <= kFine) {
    if (cells.areParted(from.node, to.node)) steps_.push_back({first, last, from, to});
    return;
  }
  const double middle = (first + last) / 2;
  const WoundPlace at = cells.placeOf(a + middle * (b - a));
  findSteps(cells, edge, first, from, middle, at);
  findSteps(cells, edge, middle, at, last, to);
}

void WoundSkin::splitEdge(const CutCells& cells, uint32_t edge) {
  const auto [a, b] = index_.edges[edge];
  steps_.clear();
  findSteps(cells, edge, 0, places_[a], 1, places_[b]);
  if (steps_.empty()) return;
  if (steps_.size() > 1) {
    const uint32_t from = steps_.front().from.node, to = steps_.back().to.node;
    const Vector3i apart = cells.lattice().nodeAt(from) - cells.lattice().nodeAt(to);
    if (from == to || (apart.cwiseAbs().maxCoeff() <= 1 && !cells.areParted(from, to))) return;  // in and out again
    ++slivers_;
  }
  // A sliver is given to what lies beyond it.
  const double least = std::min(kLeastShare, kLeastPiece / (index_.points[b] - index_.points[a]).norm());
  const double share = std::clamp((steps_.front().before + steps_.back().behind) / 2, least, 1 - least);
  copies_[edge] = own_ + static_cast<uint32_t>(added_.size());
  crossed_.push_back(edge);
  const Vector3d point = index_.points[a] + share * (index_.points[b] - index_.points[a]);
  const Vector3d normal =
      ((1 - share) * index_.normals[a].cast<double>() + share * index_.normals[b].cast<double>()).stableNormalized();
  addVertex({point, normal, steps_.front().from, a}, edge, false);
  addVertex({point, normal, steps_.back().to, b}, edge, false);
}

uint32_t WoundSkin::copyAt(uint32_t edge, uint32_t vertex) const {
  return copies_[edge] + (index_.edges[edge][0] == vertex ? 0 : 1);
}

/// A bit for each of a triangle's edges.
uint32_t WoundSkin::crossedEdges(uint32_t triangle) const {
  uint32_t crossed = 0;
  for (uint32_t i = 0; i < 3; ++i) crossed |= (copies_[index_.triangle_edges[triangle][i]] != kNoEdge ? 1U : 0U) << i;
  return crossed;
}

/// The edge where a wound comes into a triangle without going on; kNoEdge in others.
uint32_t WoundSkin::onlyCrossed(uint32_t triangle) const {
  const uint32_t crossed = crossedEdges(triangle);
  return (crossed & (crossed - 1)) == 0 && crossed != 0 ? index_.triangle_edges[triangle][crossed >> 1U] : kNoEdge;
}

/// What comes from nowhere and goes nowhere on either side of an edge is no wound.
void WoundSkin::dropLonely() {
  for (const uint32_t t : near_) {
    const uint32_t edge = onlyCrossed(t);
    if (edge == kNoEdge) continue;
    const auto [one, other] = index_.edge_triangles[edge];
    if (other != WoundSkinIndex::kNone && onlyCrossed(one == t ? other : one) == edge) copies_[edge] = kNoEdge;
  }
}

uint32_t WoundSkin::addVertex(const WoundVertex& vertex, uint32_t edge, bool is_end) {
  added_.push_back(vertex);
  edge_of_.push_back(edge);
  is_end_.push_back(is_end);
  return own_ + static_cast<uint32_t>(added_.size() - 1);
}

void WoundSkin::setTriangle(size_t at, uint32_t source, const uint32_t* corners) {
  std::copy_n(corners, 3, &triangles_[3 * at]);
  sources_[at] = source;
}

void WoundSkin::addTriangle(uint32_t source, uint32_t a, uint32_t b, uint32_t c) {
  const uint32_t corners[] = {a, b, c};
  if (place_is_free_) {
    setTriangle(source, source, corners);
    place_is_free_ = false;
    return;
  }
  triangles_.insert(triangles_.end(), corners, corners + 3);
  sources_.push_back(source);
}

void WoundSkin::addPiece(const CutCells& cells, uint32_t triangle, std::initializer_list<uint32_t> vertices) {
  const uint32_t* const v = vertices.begin();
  if (!isShown(cells, v[0])) return;
  for (size_t i = 2; i < vertices.size(); ++i) addTriangle(triangle, v[0], v[i - 1], v[i]);
}

/// In the places of triangles of which nothing is shown.
void WoundSkin::closeGaps() {
  std::sort(gaps_.begin(), gaps_.end());
  for (auto gap = gaps_.rbegin(); gap != gaps_.rend(); ++gap) {  // from behind: what is last is never one itself
    const size_t last = sources_.size() - 1;
    const std::array<uint32_t, 3> corners = {triangles_[3 * last], triangles_[3 * last + 1], triangles_[3 * last + 2]};
    const uint32_t source = sources_[last];
    if (last < index_.triangle_edges.size()) replaced_.push_back(static_cast<uint32_t>(last));
    setTriangle(*gap, source, corners.data());
    triangles_.resize(3 * last);
    sources_.resize(last);
  }
}

void WoundSkin::addLip(const CutCells& cells, uint32_t triangle, uint32_t from, uint32_t to, uint32_t corner) {
  if (!isShown(cells, corner)) return;
  const Vector3d middle = (pointOf(from) + pointOf(to)) / 2;
  const CutCell* cell = cells.find(cells.placeOf(middle).cell);
  for (const uint32_t end : {from, to}) {
    if (cell == nullptr) cell = cells.find(placeOf(end).cell);
  }
  const Vector3d along = (pointOf(to) - pointOf(from)).stableNormalized(), across = middle - pointOf(corner);
  lips_.push_back({from, to, triangle});
  lips_.back().outward = (across - across.dot(along) * along).stableNormalized();
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

/// Where the wound ends in a triangle into which it comes across its edge `first`: on as it ran in the triangle before.
Vector3d WoundSkin::endOf(uint32_t triangle, uint32_t first) const {
  const auto& corners = skin_.mesh.triangles[triangle];
  const uint32_t edge = index_.triangle_edges[triangle][first];
  const Vector3d &v = index_.points[corners[first]], &w = index_.points[corners[(first + 1) % 3]],
                 &tip = index_.points[corners[(first + 2) % 3]];
  const Vector3d at = added_[copies_[edge] - own_].point;
  Vector3d way = tip - at;
  const auto [one, other] = index_.edge_triangles[edge];
  const uint32_t before = one == triangle ? other : one;
  if (before != WoundSkinIndex::kNone) {
    Vector3d from = Vector3d::Zero();
    int count = 0;
    for (const uint32_t e : index_.triangle_edges[before]) {
      if (e == edge || copies_[e] == kNoEdge) continue;
      from += added_[copies_[e] - own_].point;
      ++count;
    }
    if (count > 0) way = at - from / count;
  }
  // In shares of the corners: the way ends before it leaves the triangle.
  const Vector3d vw = w - v, vt = tip - v, normal = vw.cross(vt);
  const double area2 = normal.squaredNorm();
  if (area2 == 0) return at + kOtherwise * (tip - at);
  const auto shares = [&](const Vector3d& d) {
    return Eigen::Vector2d(normal.dot(d.cross(vt)) / area2, normal.dot(vw.cross(d)) / area2);
  };
  const Eigen::Vector2d here = shares(at - v), along = shares(way);
  if (along.y() <= kLeastAlong * along.cwiseAbs().maxCoeff()) return at + kOtherwise * (tip - at);
  double reach = std::numeric_limits<double>::infinity();
  if (along.x() < 0) reach = std::min(reach, -here.x() / along.x());
  const double sum = along.x() + along.y();
  if (sum > 0) reach = std::min(reach, (1 - here.x() - here.y()) / sum);
  const Eigen::Vector2d end = here + kOfTheWay * reach * along;
  return v + end.x() * vw + end.y() * vt;
}

void WoundSkin::showTapered(const CutCells& cells, uint32_t triangle, uint32_t first) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const uint32_t v = corners[first], w = corners[(first + 1) % 3], tip = corners[(first + 2) % 3];
  const uint32_t edge = index_.triangle_edges[triangle][first], of_v = copyAt(edge, v), of_w = copyAt(edge, w);
  const Vector3d at = endOf(triangle, first);
  const uint32_t end = addVertex({at, added_[of_v - own_].normal, cells.placeOf(at), v}, kNoEdge, true);
  addPiece(cells, triangle, {v, of_v, end});
  addLip(cells, triangle, of_v, end, v);
  addPiece(cells, triangle, {w, end, of_w});
  addLip(cells, triangle, end, of_w, w);
  addPiece(cells, triangle, {tip, end, w});
  addPiece(cells, triangle, {tip, v, end});
}

void WoundSkin::showParted(const CutCells& cells, uint32_t triangle, uint32_t corner) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const auto& edges = index_.triangle_edges[triangle];
  const uint32_t a = corners[corner], b = corners[(corner + 1) % 3], c = corners[(corner + 2) % 3];
  const uint32_t ab = edges[corner], ca = edges[(corner + 2) % 3];
  addPiece(cells, triangle, {a, copyAt(ab, a), copyAt(ca, a)});
  addLip(cells, triangle, copyAt(ab, a), copyAt(ca, a), a);
  addPiece(cells, triangle, {b, c, copyAt(ca, c), copyAt(ab, b)});
  addLip(cells, triangle, copyAt(ca, c), copyAt(ab, b), b);
}

void WoundSkin::showStar(const CutCells& cells, uint32_t triangle) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const auto& edges = index_.triangle_edges[triangle];
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
  for (size_t i = 0; i < 3; ++i) {
    middle += (pointOf(copyAt(edges[i], corners[i])) + pointOf(copyAt(edges[i], corners[(i + 1) % 3]))) / 6;
    normal += index_.normals[corners[i]].cast<double>();
  }
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t a = corners[i], to_next = copyAt(edges[i], a), to_last = copyAt(edges[(i + 2) % 3], a);
    const uint32_t centre = addVertex({middle, normal.stableNormalized(), placeOf(to_next), a}, kNoEdge, false);
    addPiece(cells, triangle, {a, to_next, centre, to_last});
    addLip(cells, triangle, to_next, centre, a);
    addLip(cells, triangle, centre, to_last, a);
  }
}

void WoundSkin::show(const CutCells& cells, uint32_t triangle) {
  const auto& corners = skin_.mesh.triangles[triangle];
  const uint32_t crossed = crossedEdges(triangle);
  if (crossed == 0 && isShown(cells, corners[0])) return;  // it is there
  replaced_.push_back(triangle);
  place_is_free_ = true;
  if (crossed == 1 || crossed == 2 || crossed == 4) showTapered(cells, triangle, crossed >> 1U);
  if (crossed == 3) showParted(cells, triangle, 1);
  if (crossed == 6) showParted(cells, triangle, 2);
  if (crossed == 5) showParted(cells, triangle, 0);
  if (crossed == 7) showStar(cells, triangle);
  if (place_is_free_) gaps_.push_back(triangle);
  place_is_free_ = false;
}

void WoundSkin::update(const CutCells& cells) {
  forget();
  findNear(cells);
  findGone(cells);
  findPlaces(cells);
  for (const uint32_t t : near_) {
    for (const uint32_t edge : index_.triangle_edges[t]) {
      if (seen_edges_.first(edge, mark_)) splitEdge(cells, edge);
    }
  }
  dropLonely();
  for (const uint32_t t : near_) show(cells, t);
  for (const uint32_t t : gone_) show(cells, t);
  closeGaps();
}

}  // namespace viscera
