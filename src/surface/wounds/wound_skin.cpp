// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_skin.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/skins/keep_room.h"

namespace viscera {

namespace {

// In cells.
constexpr double kStep = 0.125;  // step along an edge; a wedge thinner than it may be passed over
constexpr double kFine = 1e-4;   // precision of a crossing
constexpr double kLeastPiece =
    0.05;  // least distance of a crossing from the end of an edge: thinner pieces turn over when pulled
constexpr double kLeastShare = 0.25;  // but at most this share of a short edge
constexpr int kReach = 2;             // cells: from a cell to those with edges that its change may split, and one more
constexpr double kSamples = 4;        // WoundSkinIndex samples triangles at 1 / kSamples of their longest edge

}  // namespace

WoundSkin::WoundSkin(const Skin& skin, const Lattice& lattice)
    : skin_(skin),
      index_(skin, lattice),
      own_(static_cast<uint32_t>(skin.bindings.size())),
      positions_(index_.positions) {
  reach_ = kReach + static_cast<int>(std::ceil(index_.longest / kSamples));
  const size_t triangles = skin.mesh.triangles.size(), edges = index_.edges.size();
  seen_triangles_.marks.resize(triangles);
  seen_vertices_.marks.resize(own_);
  seen_edges_.marks.resize(edges);
  judged_edges_.marks.resize(edges);
  found_.assign(edges, kNoEdge);
  copies_.assign(edges, kNoEdge);
  is_sliver_.resize(edges);
  shown_of_.assign(triangles, kNone);
  rebound_at_.assign(own_, kNone);
  for (uint32_t t = 0; t < triangles; ++t) {
    triangles_.insert(triangles_.end(), skin.mesh.triangles[t].begin(), skin.mesh.triangles[t].end());
    sources_.push_back(t);
  }
}

/// Makes the mesh whole again.
void WoundSkin::clear() {
  changed_.clear();
  near_.clear();
  looked_at_.clear();
  looked_at_added_.clear();
  for (const uint32_t vertex : rebound_) {
    positions_[vertex] = index_.positions[vertex];
    rebound_at_[vertex] = kNone;
  }
  rebound_.clear();
  for (const Owner& owner : owners_) {
    if (owner.edge == kNoEdge) continue;
    found_[owner.edge] = copies_[owner.edge] = kNoEdge;
    is_sliver_[owner.edge] = false;
  }
  for (const VisiblePieces& pieces : shown_) {
    if (pieces.triangle == kNone) continue;
    shown_of_[pieces.triangle] = kNone;
    moved_.push_back(pieces.triangle);
  }
  shown_.clear();
  free_shown_.clear();
  writeTriangles();
  added_.clear();
  owners_.clear();
  is_end_.clear();
  changed_marks_.clear();
  looked_marks_.clear();
  free_vertices_.clear();
  free_pairs_.clear();
  slivers_ = 0;
}

/// Finds triangles where the cells, or the nodes that carry their vertices, have changed.
void WoundSkin::findNear(const CutCells& cells) {
  near_.clear();
  const auto record = [&](uint32_t cell) {
    index_.of_cells.forEach(cell, [&](uint32_t triangle) {
      if (seen_triangles_.first(triangle, mark_)) appendTo(near_, triangle);
    });
  };
  cells.forEachCellNear(reach_, record);
  for (const uint32_t slot : cells.changedSlots())
    index_.of_slots.forEach(slot, [&](uint32_t v) { record(index_.positions[v].cell); });
}

/// Returns whether a triangle lies in a cut cell.
bool WoundSkin::isNear(const CutCells& cells, uint32_t triangle) const {
  bool near = false;
  index_.cells_of.forEach(triangle, [&](uint32_t cell) { near = near || cells.find(cell) != nullptr; });
  return near;
}

/// Returns whether a triangle lies in a cell at a node that has lost all of its springs.
bool WoundSkin::isNearGone(const CutCells& cells, uint32_t triangle) const {
  bool gone = false;
  index_.cells_of.forEach(triangle, [&](uint32_t cell) {
    const Vector3i at = cells.lattice().nodeAt(cell);
    for (int c = 0; c < 8; ++c) {
      const int64_t corner = cells.slotAt(at + Vector3i(c & 1, c >> 1 & 1, c >> 2));
      gone = gone || (corner >= 0 && cells.isGone(static_cast<uint32_t>(corner)));
    }
  });
  return gone;
}

void WoundSkin::updateVertex(const CutCells& cells, uint32_t v) {
  if (!seen_vertices_.first(v, mark_)) return;
  const layout::SkinBinding& binding = skin_.bindings[v];
  const bool in_cut = cells.find(index_.positions[v].cell) != nullptr;
  const bool torn = (cells.isSevered(binding.slot0) || cells.isSevered(binding.slot2)) &&
                    (!cells.isAlive(binding.slot0, binding.springs & 31U) ||
                     !cells.isAlive(binding.slot2, binding.springs >> 10U & 31U));
  positions_[v] = in_cut ? cells.positionOf(index_.points[v]) : index_.positions[v];
  const bool now = in_cut || torn, before = isRebound(v);
  if (now || before) appendTo(looked_at_, v);
  if (now && !before) {
    rebound_at_[v] = static_cast<uint32_t>(rebound_.size());
    appendTo(rebound_, v);
  } else if (before && !now) {
    rebound_at_[rebound_.back()] = rebound_at_[v];
    rebound_[rebound_at_[v]] = rebound_.back();
    rebound_.pop_back();
    rebound_at_[v] = kNone;
  }
}

void WoundSkin::findPositions(const CutCells& cells) {
  looked_at_.clear();
  for (const uint32_t t : near_)
    for (const uint32_t v : skin_.mesh.triangles[t]) updateVertex(cells, v);
  for (const uint32_t slot : cells.changedSlots())
    index_.of_slots.forEach(slot, [&](uint32_t v) { updateVertex(cells, v); });
}

void WoundSkin::findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPoint& from, double last,
                          const WoundPoint& to) {
  const Vector3d &a = index_.points[index_.edges[edge][0]], &b = index_.points[index_.edges[edge][1]];
  const double length = (last - first) * (b - a).norm();
  if (from.node == to.node && length <= kStep) return;
  if (length <= kFine) {
    if (cells.areParted(from.node, to.node)) steps_.push_back({first, last, from, to});
    return;
  }
  const double middle = (first + last) / 2;
  const WoundPoint at = cells.positionOf(a + middle * (b - a));
  findSteps(cells, edge, first, from, middle, at);
  findSteps(cells, edge, middle, at, last, to);
}

/// Returns whether a wound crosses an edge; writes the position to crossing_.
bool WoundSkin::findCrossing(const CutCells& cells, uint32_t edge, bool& sliver) {
  const auto [a, b] = index_.edges[edge];
  steps_.clear();
  findSteps(cells, edge, 0, positions_[a], 1, positions_[b]);
  if (steps_.empty()) return false;
  if (steps_.size() > 1) {
    const uint32_t from = steps_.front().from.node, to = steps_.back().to.node;
    const Vector3i apart = cells.lattice().nodeAt(from) - cells.lattice().nodeAt(to);
    if (from == to || (apart.cwiseAbs().maxCoeff() <= 1 && !cells.areParted(from, to))) return false;  // in and out
    sliver = true;
  }
  // The sliver is shown as part of its neighbours.
  const double least = std::min(kLeastShare, kLeastPiece / (index_.points[b] - index_.points[a]).norm());
  const double share = std::clamp((steps_.front().before + steps_.back().behind) / 2, least, 1 - least);
  const Vector3d point = index_.points[a] + share * (index_.points[b] - index_.points[a]);
  const Vector3d normal =
      ((1 - share) * index_.normals[a].cast<double>() + share * index_.normals[b].cast<double>()).stableNormalized();
  crossing_ = {WoundVertex{point, normal, steps_.front().from, a}, WoundVertex{point, normal, steps_.back().to, b}};
  return true;
}

void WoundSkin::updateEdge(const CutCells& cells, uint32_t edge) {
  const auto near = [&](uint32_t triangle) { return triangle != WoundSkinIndex::kNone && isNear(cells, triangle); };
  const auto [one, other] = index_.edge_triangles[edge];
  bool sliver = false;
  const bool crossed = (near(one) || near(other)) && findCrossing(cells, edge, sliver);
  slivers_ += sliver ? 1 : 0;
  slivers_ -= is_sliver_[edge] ? 1 : 0;
  is_sliver_[edge] = sliver;
  uint32_t& found = found_[edge];
  if (!crossed && found == kNoEdge) return;
  if (!crossed) {
    for (const uint32_t vertex : {found, found + 1}) free(vertex);
    appendTo(free_pairs_, found);
    found = kNoEdge;
    appendTo(changed_edges_, edge);
    return;
  }
  const bool is_new = found == kNoEdge;
  if (is_new) found = newVertices(2, free_pairs_);
  for (uint32_t i = 0; i < 2; ++i) {
    setVertex(found + i, crossing_[i], {edge, kNone, i}, false);
    recordVisited(found + i);
  }
  if (is_new || changed_marks_[found - own_] == mark_ || changed_marks_[found + 1 - own_] == mark_)
    appendTo(changed_edges_, edge);
}

void WoundSkin::updateEdges(const CutCells& cells) {
  changed_edges_.clear();
  for (const uint32_t t : near_) {
    for (const uint32_t edge : index_.triangle_edges[t]) {
      if (seen_edges_.first(edge, mark_)) updateEdge(cells, edge);
    }
  }
}

/// Returns the only crossed edge of a triangle, where a wound ends; kNoEdge for other triangles.
uint32_t WoundSkin::onlyFound(uint32_t triangle) const {
  uint32_t only = kNoEdge;
  for (const uint32_t edge : index_.triangle_edges[triangle]) {
    if (found_[edge] == kNoEdge) continue;
    if (only != kNoEdge) return kNoEdge;
    only = edge;
  }
  return only;
}

/// Returns whether no other edge on either side is crossed: then it is not a wound.
bool WoundSkin::isLonely(uint32_t edge) const {
  const auto [one, other] = index_.edge_triangles[edge];
  return other != WoundSkinIndex::kNone && onlyFound(one) == edge && onlyFound(other) == edge;
}

/// Drops lonely crossings. Also visits triangles around those that change, as the end of a wound depends on them.
void WoundSkin::dropLonely() {
  const auto visit = [&](uint32_t edge, auto of_triangle) {
    for (const uint32_t triangle : index_.edge_triangles[edge])
      if (triangle != WoundSkinIndex::kNone) of_triangle(triangle);
  };
  const auto check = [&](uint32_t triangle) {
    if (seen_triangles_.first(triangle, mark_)) appendTo(near_, triangle);
  };
  const auto judge = [&](uint32_t edge) {
    if (!judged_edges_.first(edge, mark_)) return;
    const uint32_t now = found_[edge] == kNoEdge || isLonely(edge) ? kNoEdge : found_[edge];
    const bool moved =
        now != kNoEdge && (changed_marks_[now - own_] == mark_ || changed_marks_[now + 1 - own_] == mark_);
    if (now == copies_[edge] && !moved) return;
    copies_[edge] = now;
    visit(edge, [&](uint32_t triangle) {
      check(triangle);
      for (const uint32_t beside : index_.triangle_edges[triangle]) visit(beside, check);
    });
  };
  for (const uint32_t edge : changed_edges_)
    visit(edge, [&](uint32_t triangle) {
      for (const uint32_t other : index_.triangle_edges[triangle]) judge(other);
    });
}

uint64_t WoundSkin::orderOf(uint32_t vertex) const {
  const Owner& owner = owners_[vertex - own_];
  constexpr uint64_t kInside = uint64_t{1} << 40U;
  return owner.edge != kNoEdge ? 2 * uint64_t{owner.edge} + owner.which
                               : kInside + 4 * uint64_t{owner.triangle} + owner.which;
}

/// Returns the first of `count` new vertices. @param freed  first ones of groups of as many that are free
uint32_t WoundSkin::newVertices(size_t count, std::vector<uint32_t>& freed) {
  if (!freed.empty()) {
    const uint32_t first = freed.back();
    freed.pop_back();
    return first;
  }
  const auto first = own_ + static_cast<uint32_t>(added_.size());
  for (size_t i = 0; i < count; ++i) {
    appendTo(added_, WoundVertex());
    appendTo(owners_, Owner());
    keepRoom(is_end_, is_end_.size() + 1);
    is_end_.push_back(true);
    appendTo(changed_marks_, 0U);
    appendTo(looked_marks_, 0U);
  }
  return first;
}

void WoundSkin::setVertex(uint32_t vertex, const WoundVertex& to, const Owner& owner, bool is_end) {
  const uint32_t i = vertex - own_;
  WoundVertex& known = added_[i];
  Owner& of = owners_[i];
  const bool same = known.point == to.point && known.normal == to.normal && known.position.cell == to.position.cell &&
                    known.position.within == to.position.within && known.position.node == to.position.node &&
                    known.skin_vertex == to.skin_vertex && of.edge == owner.edge && of.triangle == owner.triangle &&
                    of.which == owner.which && is_end_[i] == is_end;
  if (same) return;
  known = to;
  of = owner;
  is_end_[i] = is_end;
  changed_marks_[i] = mark_;
}

/// Frees the vertex. It stays where it is until it is used again.
void WoundSkin::free(uint32_t vertex) {
  is_end_[vertex - own_] = true;
  changed_marks_[vertex - own_] = mark_;
}

void WoundSkin::recordVisited(uint32_t vertex) {
  if (looked_marks_[vertex - own_] == mark_) return;
  looked_marks_[vertex - own_] = mark_;
  appendTo(looked_at_added_, vertex - own_);
}

void WoundSkin::setTriangle(size_t at, uint32_t source, const uint32_t* corners) {
  std::copy_n(corners, 3, &triangles_[3 * at]);
  sources_[at] = source;
}

/// Writes one piece of each triangle in its place, and the others after all.
void WoundSkin::writeTriangles() {
  const size_t whole = index_.triangle_edges.size();
  triangles_.resize(3 * whole);
  sources_.resize(whole);
  for (const uint32_t t : moved_) setTriangle(t, t, skin_.mesh.triangles[t].data());
  moved_.clear();
  gaps_.clear();
  for (const VisiblePieces& pieces : shown_) {
    if (pieces.triangle == kNone) continue;
    if (pieces.count == 0) appendTo(gaps_, pieces.triangle);
    if (pieces.count > 0) setTriangle(pieces.triangle, pieces.triangle, pieces.pieces[0].data());
    keepRoom(triangles_, triangles_.size() + 3 * size_t{pieces.count});
    for (size_t i = 1; i < pieces.count; ++i) {
      triangles_.insert(triangles_.end(), pieces.pieces[i].begin(), pieces.pieces[i].end());
      appendTo(sources_, pieces.triangle);
    }
  }
  closeGaps();
}

/// Moves triangles into the places of those of which nothing is shown.
void WoundSkin::closeGaps() {
  std::sort(gaps_.begin(), gaps_.end());
  for (auto gap = gaps_.rbegin(); gap != gaps_.rend(); ++gap) {  // from the end: the last triangle is never a gap
    const size_t last = sources_.size() - 1;
    const std::array<uint32_t, 3> corners = {triangles_[3 * last], triangles_[3 * last + 1], triangles_[3 * last + 2]};
    const uint32_t source = sources_[last];
    if (last < index_.triangle_edges.size()) appendTo(moved_, static_cast<uint32_t>(last));
    appendTo(moved_, *gap);
    setTriangle(*gap, source, corners.data());
    triangles_.resize(3 * last);
    sources_.resize(last);
  }
}

void WoundSkin::update(const CutCells& cells) {
  if (cells.isWhole()) return clear();
  ++mark_;
  changed_.clear();
  looked_at_added_.clear();
  findNear(cells);
  findPositions(cells);
  updateEdges(cells);
  dropLonely();
  for (const uint32_t t : near_) show(cells, t);
  writeTriangles();
}

}  // namespace viscera
