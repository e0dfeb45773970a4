// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What quads and fans of a wound's walls leave open is filled, and points give way where triangles are folded.
#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/keep_room.h"
#include "surface/wound_walls.h"

namespace viscera {

namespace {

// Of a triangle at a point, signed by the side that its wall faces: the sine of the angle between its shortest and
// longest side, or if that is less how far the point is from the side across, in kTall cells. Below the first a point
// is moved, above the second nothing is to be won. Neighbours that are carried by different nodes do not turn it over
// then.
constexpr double kFolded = 0.2, kWellShaped = 0.5, kTall = 0.3;
constexpr double kNoSide = 1e-6;  // a sum of ways across a wound that are of both sides
constexpr double kAll = 0.05;  // what the mean of all triangles counts beside the worst: ways lead out of two bad ones
constexpr int kRounds = 3;     // over all points: those around one move too
constexpr int kMoves = 4;      // of a point in a round
constexpr double kSteps[] = {0.5, 0.2, -0.2,
                             -0.5};  // of the way to a neighbour: in a flat cut all of them in its plane
constexpr double kFarthest = 0.7;    // cells that a point may leave its place by

uint64_t pairOf(uint32_t a, uint32_t b) {
  return uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

/// @param at  the point
double shapeOf(const Vector3d& at, const Vector3d& b, const Vector3d& c, const Vector3d& outward) {
  const Vector3d ab = b - at, ac = c - at, bc = c - b, area = ab.cross(ac);
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), bc2 = bc.squaredNorm();
  const double sides = std::sqrt(std::max({ab2, ac2, bc2}) * std::min({ab2, ac2, bc2}));
  if (sides == 0) return 0;
  const double size = area.norm(), shape = std::min(size / sides, size / (std::sqrt(bc2) * kTall));
  return area.dot(outward) < 0 ? -shape : shape;
}

}  // namespace

void WoundWalls::findOpenEdges() {
  edges_.clear();
  const auto note = [&](uint32_t a, uint32_t b) { edges_.emplace_back(pairOf(a, b), a < b ? 1 : -1); };
  for (size_t t = 0; t < triangles_.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) note(triangles_[t + i], triangles_[t + (i + 1) % 3]);
  }
  for (const Lip& lip : skin_->lips()) note(lipVertex(lip.from), lipVertex(lip.to));
  std::sort(edges_.begin(), edges_.end());
  open_.clear();
  size_t kept = 0;
  for (size_t i = 0; i < edges_.size();) {
    const uint64_t edge = edges_[i].first;
    int sum = 0;
    for (; i < edges_.size() && edges_[i].first == edge; ++i) sum += edges_[i].second;
    edges_[kept++] = {edge, sum};
    const auto low = static_cast<uint32_t>(edge >> 32U), high = static_cast<uint32_t>(edge);
    for (; sum > 0; --sum) open_.push_back({low, high});
    for (; sum < 0; ++sum) open_.push_back({high, low});
  }
  edges_.resize(kept);
  std::sort(open_.begin(), open_.end());
  keepRoom(walked_, open_.size());
  walked_.assign(open_.size(), false);
}

/// @returns whether the way goes on; rings that it closes are filled and taken out of it
bool WoundWalls::stepAlongHole() {
  auto next =
      static_cast<size_t>(std::lower_bound(open_.begin(), open_.end(), OpenEdge{way_.back(), 0}) - open_.begin());
  while (next < open_.size() && open_[next].from == way_.back() && walked_[next]) ++next;
  if (next == open_.size() || open_[next].from != way_.back()) {  // at a border of the skin: nothing closes there
    ++holes_;
    return false;
  }
  walked_[next] = true;
  const uint32_t vertex = open_[next].to;
  const auto met = std::find(way_.begin(), way_.end(), vertex);
  if (met == way_.end()) {
    way_.push_back(vertex);
    return true;
  }
  const auto first = static_cast<size_t>(met - way_.begin());
  closeRing(first);
  way_.resize(first + 1);
  return way_.size() > 1;
}

/// What is still open: where lips step from cell to cell across an edge of the lattice, where they end before the cut
/// inside does. Such holes are rings of a few edges between points of neighbouring cells.
void WoundWalls::closeHoles() {
  findOpenEdges();
  chords_.clear();
  for (size_t i = 0; i < open_.size(); ++i) {
    while (!walked_[i]) {  // more than once where another edge leads away from its start
      way_.assign(1, open_[i].from);
      while (stepAlongHole()) {
      }
    }
  }
}

bool WoundWalls::isEdge(uint32_t a, uint32_t b) const {
  const uint64_t edge = pairOf(a, b);
  const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::make_pair(edge, INT32_MIN));
  return (found != edges_.end() && found->first == edge) ||
         std::find(chords_.begin(), chords_.end(), edge) != chords_.end();
}

/// A fan from the least point of a ring, the end of the way, so that the two sides of a wound are filled alike; but not
/// from one that the other side has in the ring as well, which would span a web from lip to lip. Where an edge of the
/// fan is one already, which would get four triangles, from the middle of the ring.
void WoundWalls::closeRing(size_t first) {
  const auto begin = way_.begin() + static_cast<ptrdiff_t>(first), end = way_.end();
  const auto point = [&](uint32_t vertex) -> const Vector3d& { return vertices_[vertex].point; };
  const auto has_twin = [&](uint32_t vertex) {
    return std::count_if(begin, end, [&](uint32_t v) { return point(v) == point(vertex); }) > 1;
  };
  const auto before = [&](uint32_t a, uint32_t b) {
    const bool twin_a = has_twin(a), twin_b = has_twin(b);
    if (twin_a != twin_b) return twin_b;
    return std::lexicographical_compare(point(a).data(), point(a).data() + 3, point(b).data(), point(b).data() + 3);
  };
  const uint32_t start = *begin;
  std::rotate(begin, std::min_element(begin, end, before), end);
  const auto count = static_cast<size_t>(end - begin);
  bool taken = false;
  for (size_t i = 2; i + 1 < count; ++i) taken = taken || isEdge(*begin, begin[static_cast<ptrdiff_t>(i)]);
  if (taken) {
    WoundVertex middle;
    middle.place = {kNone, Vector3f::Zero(), 0};
    for (auto v = begin; v != end; ++v) {
      middle.point += point(*v) / static_cast<double>(count);
      if (middle.place.cell == kNone && cell_of_[*v] != kNone) middle.place = vertices_[*v].place;
    }
    if (middle.place.cell == kNone) middle.place = skin_->placeOf(vertices_[*begin].skin_vertex);
    const uint32_t centre = addVertex(middle, kNone, Vector3d::Zero());
    for (size_t i = 0; i < count; ++i)
      add(centre, begin[static_cast<ptrdiff_t>((i + 1) % count)], begin[static_cast<ptrdiff_t>(i)]);
  } else {
    for (size_t i = 2; i < count; ++i) {
      add(*begin, begin[static_cast<ptrdiff_t>(i)], begin[static_cast<ptrdiff_t>(i - 1)]);
      if (i + 1 < count) chords_.push_back(pairOf(*begin, begin[static_cast<ptrdiff_t>(i)]));
    }
  }
  *begin = start;  // where the way goes on
}

void WoundWalls::listTrianglesOfCells() {
  const size_t cells = points_.size();
  keepRoom(cell_starts_, cells + 2);
  cell_starts_.assign(cells + 2, 0);
  for (const uint32_t v : triangles_) {
    if (cell_of_[v] != kNone) ++cell_starts_[cell_of_[v] + 2];
  }
  for (size_t c = 2; c < cells + 2; ++c) cell_starts_[c] += cell_starts_[c - 1];
  cell_triangles_.resize(cell_starts_[cells + 1]);
  for (uint32_t i = 0; i < triangles_.size(); ++i) {
    const uint32_t cell = cell_of_[triangles_[i]];
    if (cell != kNone) cell_triangles_[cell_starts_[cell + 1]++] = i / 3;
  }
}

/// How well a point's triangles were shaped if it were there.
WoundWalls::Shape WoundWalls::shapeAt(uint32_t cell, const Vector3d& at) const {
  Shape shape;
  double sum = 0;
  int count = 0;
  for (uint32_t i = cell_starts_[cell]; i < cell_starts_[cell + 1]; ++i) {
    const uint32_t* const corners = &triangles_[3 * size_t{cell_triangles_[i]}];
    int own = 0, moving = 0;
    for (int c = 0; c < 3; ++c) {
      if (cell_of_[corners[c]] != cell) continue;
      moving = c;
      ++own;
    }
    if (own != 1) continue;
    const Vector3d outward = outward_[corners[0]] + outward_[corners[1]] + outward_[corners[2]];
    if (outward.squaredNorm() < kNoSide) continue;  // where a cut ends inside: it may face either way
    const double next =
        shapeOf(at, vertices_[corners[(moving + 1) % 3]].point, vertices_[corners[(moving + 2) % 3]].point, outward);
    shape.worst = std::min(shape.worst, next);
    sum += std::min(next, kWellShaped);
    ++count;
  }
  shape.all = shape.worst + (count > 0 ? kAll * sum / count : 0);
  return shape;
}

void WoundWalls::relaxPoint(uint32_t cell) {
  ring_.clear();
  for (uint32_t i = cell_starts_[cell]; i < cell_starts_[cell + 1]; ++i) {
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t v = triangles_[3 * size_t{cell_triangles_[i]} + c];
      if (cell_of_[v] != cell) ring_.push_back(v);
    }
  }
  std::sort(ring_.begin(), ring_.end());
  ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
  Vector3d& at = points_[cell].at;
  const Vector3d first = at;
  Shape shape = shapeAt(cell, at);
  for (int step = 0; step < kMoves && shape.worst < kWellShaped; ++step) {
    Vector3d best = at;
    for (const uint32_t towards : ring_) {
      for (const double share : kSteps) {
        const Vector3d there = at + share * (vertices_[towards].point - at);
        if ((there - first).squaredNorm() > kFarthest * kFarthest) continue;
        if (!cells_->isCell(there.array().floor().cast<int>())) continue;
        const Shape shape_there = shapeAt(cell, there);
        if (shape_there.all <= shape.all) continue;
        shape = shape_there;
        best = there;
      }
    }
    if (best == at) break;
    at = best;
  }
  for (size_t component = 0; component < 8; ++component) {
    const uint32_t vertex = point_vertices_[8 * size_t{cell} + component];
    if (vertex != kNone) vertices_[vertex].point = at;
  }
}

void WoundWalls::relax() {
  listTrianglesOfCells();
  for (int round = 0; round < kRounds; ++round) {
    bool any = false;
    for (uint32_t cell = 0; cell < points_.size(); ++cell) {
      if (cell_starts_[cell] == cell_starts_[cell + 1] || points_[cell].marks == 0) continue;
      if (shapeAt(cell, points_[cell].at).worst >= kFolded) continue;
      relaxPoint(cell);
      any = true;
    }
    if (!any) break;
  }
}

}  // namespace viscera
