// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fills what quads and fans of a wound's walls leave open.
#include <algorithm>
#include <limits>

#include "surface/skins/keep_room.h"
#include "surface/wounds/wound_walls.h"

namespace viscera {

namespace {

constexpr uint64_t kFills = uint64_t{3} << 62U;    // order of triangles: after fans (wound_fans.cpp)
constexpr uint64_t kLips = uint64_t{1} << 62U;     // order of vertices: after those of points
constexpr uint64_t kMiddles = uint64_t{2} << 62U;  // ... and after those of lips

bool isFill(uint64_t order) {
  return order >= kFills;
}

}  // namespace

/// Returns the order of a vertex, which does not depend on the order of cuts.
uint64_t WoundWalls::orderOf(uint32_t vertex) const {
  const uint32_t cell = cell_of_[vertex];
  if (cell != kNone) {
    const uint32_t* const first = &point_vertices_[8 * size_t{cell}];
    return 8 * cells_->cells()[cell].order + static_cast<uint64_t>(std::find(first, first + 8, vertex) - first);
  }
  if (vertices_[vertex].skin_vertex != WoundVertex::kNone) return kLips | skin_->orderOf(vertices_[vertex].skin_vertex);
  uint64_t first = UINT64_MAX;
  mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) { first = std::min(first, mesh_.orderOf(triangle)); });
  return kMiddles | (first & ~kFills);
}

/// Gathers the edges that lead away from a vertex and have no triangle on the other side. Their ends are on the hole
/// too.
void WoundWalls::gatherOpen(uint32_t vertex) {
  ends_.clear();
  const auto record = [&](uint32_t end, int direction) { appendTo(ends_, std::make_pair(end, direction)); };
  mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t corner) {
    if (isFill(mesh_.orderOf(triangle))) return;
    const std::array<uint32_t, 3> corners = mesh_.cornersOf(triangle);
    record(corners[(corner + 1) % 3], 1);
    record(corners[(corner + 2) % 3], -1);
  });
  const uint32_t of_skin = vertices_[vertex].skin_vertex;
  if (of_skin != WoundVertex::kNone) {
    forEachLipAt(of_skin, [&](const Lip& lip) {
      if (lip.from == of_skin)
        record(lipVertex(lip.to), 1);
      else
        record(lipVertex(lip.from), -1);
    });
  }
  std::sort(ends_.begin(), ends_.end());
  for (size_t i = 0; i < ends_.size();) {
    const uint32_t end = ends_[i].first;
    int sum = 0;
    for (; i < ends_.size() && ends_[i].first == end; ++i) sum += ends_[i].second;
    if (sum != 0) around_hole_.record(end, mark_);
    for (; sum > 0; --sum) appendTo(open_, OpenEdge{orderOf(vertex), orderOf(end), vertex, end});
  }
}

/// Removes the triangles at a vertex that fill holes.
void WoundWalls::dropFill(uint32_t vertex) {
  around_.clear();
  mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) {
    if (isFill(mesh_.orderOf(triangle))) appendTo(around_, std::make_pair(mesh_.orderOf(triangle), triangle));
  });
  for (const auto& [order, triangle] : around_) {
    recordCorners(triangle);
    const std::array<uint32_t, 3> corners = mesh_.cornersOf(triangle);
    mesh_.remove(triangle);
    for (const uint32_t corner : corners) {
      if (cell_of_[corner] != kNone || vertices_[corner].skin_vertex != WoundVertex::kNone) continue;
      bool any = false;
      mesh_.forEachAt(corner, [&](uint32_t, uint32_t) { any = true; });
      if (!any) appendTo(free_vertices_, corner);  // the middle of a ring
    }
  }
}

/// Goes one edge on along a hole. Fills rings that the path closes, and removes them from it.
/// @returns whether the path continues
bool WoundWalls::stepAlongHole() {
  const OpenEdge first_there{orderOf(path_.back()), 0};
  auto next = static_cast<size_t>(std::lower_bound(open_.begin(), open_.end(), first_there) - open_.begin());
  while (next < open_.size() && open_[next].from == path_.back() && walked_[next]) ++next;
  if (next == open_.size() || open_[next].from != path_.back()) {  // at a border of the mesh: nothing closes there
    appendTo(hole_ends_, path_.back());
    return false;
  }
  walked_[next] = true;
  const uint32_t vertex = open_[next].to;
  const auto met = std::find(path_.begin(), path_.end(), vertex);
  if (met == path_.end()) {
    appendTo(path_, vertex);
    return true;
  }
  const auto first = static_cast<size_t>(met - path_.begin());
  closeRing(first);
  path_.resize(first + 1);
  return path_.size() > 1;
}

/// Fills what is still open: where lips step from cell to cell across an edge of the lattice, or end before the cut
/// inside does. Such holes are rings of a few edges between points of neighbouring cells. Rings along which something
/// has changed are filled again.
void WoundWalls::closeHoles() {
  for (const uint32_t vertex : touched_.list) around_hole_.record(vertex, mark_);
  open_.clear();
  for (size_t i = 0; i < around_hole_.list.size(); ++i) gatherOpen(around_hole_.list[i]);
  for (const uint32_t vertex : around_hole_.list) dropFill(vertex);
  const auto is_around = [&](uint32_t vertex) { return around_hole_.has(vertex, mark_); };
  hole_ends_.erase(std::remove_if(hole_ends_.begin(), hole_ends_.end(), is_around), hole_ends_.end());
  std::sort(open_.begin(), open_.end());
  keepRoom(walked_, open_.size());
  walked_.assign(open_.size(), false);
  fills_ = 0;
  for (size_t i = 0; i < open_.size(); ++i) {
    while (!walked_[i]) {  // more than once where another edge leads away from its start
      path_.clear();
      appendTo(path_, open_[i].from);
      while (stepAlongHole()) {
      }
    }
  }
}

bool WoundWalls::isEdge(uint32_t a, uint32_t b) const {
  bool found = false;
  mesh_.forEachAt(a, [&](uint32_t triangle, uint32_t) {
    for (const uint32_t corner : mesh_.cornersOf(triangle)) found = found || corner == b;
  });
  const uint32_t of_a = vertices_[a].skin_vertex, of_b = vertices_[b].skin_vertex;
  if (of_a == WoundVertex::kNone || of_b == WoundVertex::kNone) return found;
  forEachLipAt(of_a, [&](const Lip& lip) { found = found || lip.from == of_b || lip.to == of_b; });
  return found;
}

void WoundWalls::addFill(uint32_t a, uint32_t b, uint32_t c) {
  recordCorners(mesh_.add({a, b, c}, kFills | fills_++));
}

void WoundWalls::fillFromMiddle(const uint32_t* ring, size_t count) {
  WoundVertex middle;
  middle.position = {kNone, Vector3f::Zero(), 0};
  for (size_t i = 0; i < count; ++i) {
    middle.point += firstPosition(ring[i]) / static_cast<double>(count);
    if (middle.position.cell == kNone && cell_of_[ring[i]] != kNone) middle.position = vertices_[ring[i]].position;
  }
  if (middle.position.cell == kNone) middle.position = skin_->positionOf(vertices_[ring[0]].skin_vertex);
  const uint32_t centre = newVertex(middle, kNone);
  for (size_t i = 0; i < count; ++i) addFill(centre, ring[(i + 1) % count], ring[i]);
}

/// Fills a ring, the end of the path, with a fan from its least point, so that both sides of a wound are filled alike.
/// That point must not be one that the other side has in the ring as well, as the fan would span a web from lip to lip.
/// If an edge of the fan exists already, and would get four triangles, fills from the middle of the ring.
void WoundWalls::closeRing(size_t first) {
  const auto begin = path_.begin() + static_cast<ptrdiff_t>(first), end = path_.end();
  const auto point = [&](uint32_t vertex) { return firstPosition(vertex); };
  const auto has_twin = [&](uint32_t vertex) {
    return std::count_if(begin, end, [&](uint32_t v) { return point(v) == point(vertex); }) > 1;
  };
  const auto before = [&](uint32_t a, uint32_t b) {
    const bool twin_a = has_twin(a), twin_b = has_twin(b);
    if (twin_a != twin_b) return twin_b;
    const Vector3d at_a = point(a), at_b = point(b);
    return std::lexicographical_compare(at_a.data(), at_a.data() + 3, at_b.data(), at_b.data() + 3);
  };
  const uint32_t start = *begin;
  std::rotate(begin, std::min_element(begin, end, before), end);
  const auto count = static_cast<size_t>(end - begin);
  bool taken = false;
  for (size_t i = 2; i + 1 < count; ++i) taken = taken || isEdge(*begin, begin[static_cast<ptrdiff_t>(i)]);
  if (taken) {
    fillFromMiddle(&*begin, count);
  } else {
    for (size_t i = 2; i < count; ++i)
      addFill(*begin, begin[static_cast<ptrdiff_t>(i)], begin[static_cast<ptrdiff_t>(i - 1)]);
  }
  *begin = start;  // where the path continues
}

}  // namespace viscera
