// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shown pieces of a triangle with crossed edges.
#include <algorithm>
#include <array>
#include <limits>

#include "surface/skins/keep_room.h"
#include "surface/wounds/wound_skin.h"

namespace viscera {

namespace {

constexpr double kOfThePath = 0.6;    // share of the path through the triangle in which a wound ends
constexpr double kOtherwise = 0.25;   // share of the path to the third corner, where the blade's direction is unusable
constexpr double kLeastAlong = 0.05;  // of its longest share: a direction with less away from the edge is not reliable
constexpr double kBeside = 0.02;      // cells: distance from a lip at which its side is found, where no node shows it

}  // namespace

uint32_t WoundSkin::copyAt(uint32_t edge, uint32_t vertex) const {
  return copies_[edge] + (index_.edges[edge][0] == vertex ? 0 : 1);
}

/// Returns a bit for each crossed edge of a triangle.
uint32_t WoundSkin::crossedEdges(uint32_t triangle) const {
  uint32_t crossed = 0;
  for (uint32_t i = 0; i < 3; ++i) crossed |= (copies_[index_.triangle_edges[triangle][i]] != kNoEdge ? 1U : 0U) << i;
  return crossed;
}

void WoundSkin::addPiece(const CutCells& cells, std::initializer_list<uint32_t> vertices, VisiblePieces& out) const {
  const uint32_t* const v = vertices.begin();
  if (!isShown(cells, v[0])) return;
  for (size_t i = 2; i < vertices.size(); ++i) out.pieces[out.count++] = {v[0], v[i - 1], v[i]};
}

void WoundSkin::addLip(const CutCells& cells, uint32_t from, uint32_t to, uint32_t corner, VisiblePieces& out) const {
  if (!isShown(cells, corner)) return;
  const Vector3d middle = (pointOf(from) + pointOf(to)) / 2;
  const CutCell* cell = cells.find(cells.positionOf(middle).cell);
  for (const uint32_t end : {from, to}) {
    if (cell == nullptr) cell = cells.find(positionOf(end).cell);
  }
  const Vector3d along = (pointOf(to) - pointOf(from)).stableNormalized(), across = middle - pointOf(corner);
  Lip& lip = out.lips[out.lip_count++];
  lip = {from, to, out.triangle};
  lip.outward = (across - across.dot(along) * along).stableNormalized();
  if (cell == nullptr) return;
  lip.cell = static_cast<uint32_t>(cells.slotAt(cell->at));
  const bool from_split = from >= own_, to_split = to >= own_;
  if (from_split && cell->holds(positionOf(from).node)) {
    lip.node = positionOf(from).node;
  } else if (to_split && cell->holds(positionOf(to).node)) {
    lip.node = positionOf(to).node;
  } else {
    const Vector3d beside = middle + kBeside * (pointOf(corner) - middle).stableNormalized();
    const Vector3d within = (beside - cell->at.cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
    lip.node = cell->slots[static_cast<size_t>(cell->cornerAt(within.cast<float>()))];
  }
}

/// Returns where the wound ends in a triangle that it enters across edge `first`. It continues in the direction that it
/// had in the triangle before.
Vector3d WoundSkin::endOf(uint32_t triangle, uint32_t first) const {
  const auto& corners = skin_.mesh.triangles[triangle];
  const uint32_t edge = index_.triangle_edges[triangle][first];
  const Vector3d &v = index_.points[corners[first]], &w = index_.points[corners[(first + 1) % 3]],
                 &tip = index_.points[corners[(first + 2) % 3]];
  const Vector3d at = added_[copies_[edge] - own_].point;
  Vector3d offset = tip - at;
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
    if (count > 0) offset = at - from / count;
  }
  // In shares of the corners: the path ends before it leaves the triangle.
  const Vector3d vw = w - v, vt = tip - v, normal = vw.cross(vt);
  const double area2 = normal.squaredNorm();
  if (area2 == 0) return at + kOtherwise * (tip - at);
  const auto shares = [&](const Vector3d& d) {
    return Eigen::Vector2d(normal.dot(d.cross(vt)) / area2, normal.dot(vw.cross(d)) / area2);
  };
  const Eigen::Vector2d here = shares(at - v), along = shares(offset);
  if (along.y() <= kLeastAlong * along.cwiseAbs().maxCoeff()) return at + kOtherwise * (tip - at);
  double reach = std::numeric_limits<double>::infinity();
  if (along.x() < 0) reach = std::min(reach, -here.x() / along.x());
  const double sum = along.x() + along.y();
  if (sum > 0) reach = std::min(reach, (1 - here.x() - here.y()) / sum);
  const Eigen::Vector2d end = here + kOfThePath * reach * along;
  return v + end.x() * vw + end.y() * vt;
}

/// Adds a vertex within a triangle, with its old number if it had one.
uint32_t WoundSkin::addInside(VisiblePieces& out, const WoundVertex& vertex, bool is_end) {
  const uint32_t known = shown_of_[out.triangle], position = out.inside_count;
  const bool was_there = known != kNone && position < shown_[known].inside_count;
  const uint32_t number = was_there ? shown_[known].inside[position] : newVertices(1, free_vertices_);
  setVertex(number, vertex, {kNoEdge, out.triangle, position}, is_end);
  out.inside[out.inside_count++] = number;
  return number;
}

void WoundSkin::showTapered(const CutCells& cells, uint32_t first, VisiblePieces& out) {
  const auto& corners = skin_.mesh.triangles[out.triangle];
  const uint32_t v = corners[first], w = corners[(first + 1) % 3], tip = corners[(first + 2) % 3];
  const uint32_t edge = index_.triangle_edges[out.triangle][first], of_v = copyAt(edge, v), of_w = copyAt(edge, w);
  const Vector3d at = endOf(out.triangle, first);
  const uint32_t end = addInside(out, {at, added_[of_v - own_].normal, cells.positionOf(at), v}, true);
  addPiece(cells, {v, of_v, end}, out);
  addLip(cells, of_v, end, v, out);
  addPiece(cells, {w, end, of_w}, out);
  addLip(cells, end, of_w, w, out);
  addPiece(cells, {tip, end, w}, out);
  addPiece(cells, {tip, v, end}, out);
}

void WoundSkin::showParted(const CutCells& cells, uint32_t corner, VisiblePieces& out) {
  const auto& corners = skin_.mesh.triangles[out.triangle];
  const auto& edges = index_.triangle_edges[out.triangle];
  const uint32_t a = corners[corner], b = corners[(corner + 1) % 3], c = corners[(corner + 2) % 3];
  const uint32_t ab = edges[corner], ca = edges[(corner + 2) % 3];
  addPiece(cells, {a, copyAt(ab, a), copyAt(ca, a)}, out);
  addLip(cells, copyAt(ab, a), copyAt(ca, a), a, out);
  addPiece(cells, {b, c, copyAt(ca, c), copyAt(ab, b)}, out);
  addLip(cells, copyAt(ca, c), copyAt(ab, b), b, out);
}

void WoundSkin::showStar(const CutCells& cells, VisiblePieces& out) {
  const auto& corners = skin_.mesh.triangles[out.triangle];
  const auto& edges = index_.triangle_edges[out.triangle];
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
  for (size_t i = 0; i < 3; ++i) {
    middle += (pointOf(copyAt(edges[i], corners[i])) + pointOf(copyAt(edges[i], corners[(i + 1) % 3]))) / 6;
    normal += index_.normals[corners[i]].cast<double>();
  }
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t a = corners[i], to_next = copyAt(edges[i], a), to_last = copyAt(edges[(i + 2) % 3], a);
    const uint32_t centre = addInside(out, {middle, normal.stableNormalized(), positionOf(to_next), a}, false);
    addPiece(cells, {a, to_next, centre, to_last}, out);
    addLip(cells, to_next, centre, a, out);
    addLip(cells, centre, to_last, a, out);
  }
}

void WoundSkin::cutUp(const CutCells& cells, uint32_t crossed, VisiblePieces& out) {
  if (crossed == 1 || crossed == 2 || crossed == 4) showTapered(cells, crossed >> 1U, out);
  if (crossed == 3) showParted(cells, 1, out);
  if (crossed == 6) showParted(cells, 2, out);
  if (crossed == 5) showParted(cells, 0, out);
  if (crossed == 7) showStar(cells, out);
  for (uint32_t i = 0; i < out.inside_count; ++i) recordVisited(out.inside[i]);
}

/// Returns whether walls must be updated.
bool WoundSkin::isOtherThan(const VisiblePieces& before, const VisiblePieces& now) const {
  if (before.lip_count != now.lip_count) return true;
  for (size_t i = 0; i < now.lip_count; ++i) {
    const Lip &a = before.lips[i], &b = now.lips[i];
    if (a.from != b.from || a.to != b.to || a.cell != b.cell || a.node != b.node || a.outward != b.outward) return true;
    if (changed_marks_[b.from - own_] == mark_ || changed_marks_[b.to - own_] == mark_) return true;
  }
  return false;
}

void WoundSkin::show(const CutCells& cells, uint32_t triangle) {
  uint32_t crossed = crossedEdges(triangle);
  const bool corner_is_shown = isShown(cells, skin_.mesh.triangles[triangle][0]);
  if (crossed != 0 && !isNear(cells, triangle) && !isNearGone(cells, triangle)) crossed = 0;
  const bool is_whole = crossed == 0 && corner_is_shown;
  uint32_t& known = shown_of_[triangle];
  if (is_whole && known == kNone) return;
  VisiblePieces now;
  now.triangle = is_whole ? kNone : triangle;
  if (!is_whole) cutUp(cells, crossed, now);
  if (known == kNone) {
    if (free_shown_.empty()) {
      appendTo(free_shown_, static_cast<uint32_t>(shown_.size()));
      appendTo(shown_, VisiblePieces());
    }
    known = free_shown_.back();
    free_shown_.pop_back();
  }
  VisiblePieces& before = shown_[known];
  if (isOtherThan(before, now)) appendTo(changed_, known);
  for (size_t i = now.inside_count; i < before.inside_count; ++i) {
    free(before.inside[i]);
    appendTo(free_vertices_, before.inside[i]);
  }
  before = now;
  if (!is_whole) return;
  appendTo(free_shown_, known);
  appendTo(moved_, triangle);  // it is whole again
  known = kNone;
}

}  // namespace viscera
