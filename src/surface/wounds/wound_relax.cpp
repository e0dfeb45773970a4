// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Relaxes points of walls where triangles are folded, cell by cell in their order, in a few rounds. A point's new place
// depends on the places of earlier points in this round, and of later ones in the last round. A point is relaxed again
// if any of these has changed.
#include <algorithm>
#include <cmath>
#include <functional>

#include "surface/skins/keep_room.h"
#include "surface/wounds/wound_walls.h"

namespace viscera {

namespace {

// Shape of a triangle at a point, with the sign of the side that its wall faces: the sine of the angle between its
// shortest and longest side or, if that is less, the distance of the point from the opposite side in kTall cells. Below
// the first limit a point is moved, above the second it is good enough. Neighbours bound to other nodes do not turn
// such a triangle over then.
constexpr double kFolded = 0.2, kWellShaped = 0.5, kTall = 0.3;
constexpr double kNoSide = 1e-6;  // square of a sum of outward directions that cancel: both sides
constexpr double kAll = 0.05;     // weight of the mean of all triangles next to the worst, to get past two bad ones
constexpr int kMoves = 4;         // of a point in a round
constexpr double kSteps[] = {0.5, 0.2, -0.2,
                             -0.5};  // of the path to a neighbour: in a flat cut all points stay in its plane
constexpr double kFarthest = 0.7;    // cells that a point may move from its place

/// Returns the shape of a triangle. @param at  the point
double shapeOf(const Vector3d& at, const Vector3d& b, const Vector3d& c, const Vector3d& outward) {
  const Vector3d ab = b - at, ac = c - at, bc = c - b, area = ab.cross(ac);
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), bc2 = bc.squaredNorm();
  const double sides = std::sqrt(std::max({ab2, ac2, bc2}) * std::min({ab2, ac2, bc2}));
  if (sides == 0) return 0;
  const double size = area.norm(), shape = std::min(size / sides, size / (std::sqrt(bc2) * kTall));
  return area.dot(outward) < 0 ? -shape : shape;
}

}  // namespace

void WoundWalls::ask(uint32_t cell, size_t round) {
  if (round > kRounds || asked_marks_[round][cell] == mark_) return;
  asked_marks_[round][cell] = mark_;
  appendTo(asked_[round], std::make_pair(cells_->cells()[cell].order, cell));
  std::push_heap(asked_[round].begin(), asked_[round].end(), std::greater<>());
}

void WoundWalls::askAlways(uint32_t cell) {
  for (size_t round = 1; round <= kRounds; ++round) ask(cell, round);
}

/// Notes the points of all triangles at a vertex.
void WoundWalls::askAround(uint32_t vertex) {
  mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) { recordCorners(triangle); });
}

/// Notes the points that depend on a point that has moved in a round.
void WoundWalls::askOthersAround(uint32_t cell, size_t round) {
  ask(cell, round + 1);
  forEachTriangleOf(cell, [&](uint32_t triangle) {
    for (const uint32_t corner : mesh_.cornersOf(triangle)) {
      const uint32_t other = cell_of_[corner];
      if (other == kNone || other == cell) continue;
      ask(other, cells_->cells()[other].order > cells_->cells()[cell].order ? round : round + 1);
    }
  });
}

/// Returns the position of a vertex that a point uses in a round.
Vector3d WoundWalls::placeSeen(uint32_t vertex, uint32_t from_cell, size_t round) const {
  const uint32_t cell = cell_of_[vertex];
  if (cell == kNone) return vertices_[vertex].point;
  const bool was_before = cells_->cells()[cell].order < cells_->cells()[from_cell].order;
  return points_[cell].at[was_before ? round : round - 1];
}

/// Finds the triangles with one corner at the point, and the vertices across.
void WoundWalls::findFacets(uint32_t cell, size_t round) {
  facets_.clear();
  ring_.clear();
  forEachTriangleOf(cell, [&](uint32_t triangle) {
    const std::array<uint32_t, 3> corners = mesh_.cornersOf(triangle);
    size_t own = 0, moving = 0;
    for (size_t c = 0; c < 3; ++c) {
      if (cell_of_[corners[c]] != cell) {
        appendTo(ring_, std::make_pair(uint64_t{0}, corners[c]));
        continue;
      }
      moving = c;
      ++own;
    }
    if (own != 1) return;
    const Vector3d outward = outward_[corners[0]] + outward_[corners[1]] + outward_[corners[2]];
    if (outward.squaredNorm() < kNoSide) return;  // where a cut ends inside: it may face either side
    appendTo(facets_, Facet{mesh_.orderOf(triangle), placeSeen(corners[(moving + 1) % 3], cell, round),
                            placeSeen(corners[(moving + 2) % 3], cell, round), outward});
  });
  std::sort(facets_.begin(), facets_.end());
}

/// Returns the shape of a point's triangles with the point at a place.
WoundWalls::Shape WoundWalls::shapeAt(const Vector3d& at) const {
  Shape shape;
  double sum = 0;
  for (const Facet& facet : facets_) {
    const double next = shapeOf(at, facet.b, facet.c, facet.outward);
    shape.worst = std::min(shape.worst, next);
    sum += std::min(next, kWellShaped);
  }
  shape.all = shape.worst + (facets_.empty() ? 0 : kAll * sum / static_cast<int>(facets_.size()));
  return shape;
}

/// Returns the place of a point after a round.
Vector3d WoundWalls::relaxed(uint32_t cell, size_t round) {
  ++points_tried_;
  const Vector3d first = points_[cell].at[round - 1];
  if (points_[cell].marks == 0) return first;
  findFacets(cell, round);
  Shape shape = shapeAt(first);
  if (shape.worst >= kFolded) return first;
  for (auto& [order, vertex] : ring_) order = orderOf(vertex);
  std::sort(ring_.begin(), ring_.end());
  ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
  Vector3d at = first;
  for (int step = 0; step < kMoves && shape.worst < kWellShaped; ++step) {
    Vector3d best = at;
    for (const auto& [order, towards] : ring_) {
      const Vector3d to = placeSeen(towards, cell, round);
      for (const double share : kSteps) {
        const Vector3d there = at + share * (to - at);
        if ((there - first).squaredNorm() > kFarthest * kFarthest) continue;
        if (!cells_->isCell(there.array().floor().cast<int>())) continue;
        const Shape shape_there = shapeAt(there);
        if (shape_there.all <= shape.all) continue;
        shape = shape_there;
        best = there;
      }
    }
    if (best == at) break;
    at = best;
  }
  return at;
}

/// Moves a point's vertices to its final place.
void WoundWalls::setDown(uint32_t cell) {
  const Vector3d& at = points_[cell].at[kRounds];
  for (size_t component = 0; component < 8; ++component) {
    const uint32_t vertex = point_vertices_[8 * size_t{cell} + component];
    if (vertex == kNone || vertices_[vertex].point == at) continue;
    vertices_[vertex].point = at;
    to_bind_.record(vertex, mark_);
    mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) {
      for (const uint32_t corner : mesh_.cornersOf(triangle)) to_shade_.record(corner, mark_);
    });
  }
}

void WoundWalls::relax() {
  for (size_t round = 1; round <= kRounds; ++round) {
    auto& asked = asked_[round];
    while (!asked.empty()) {
      std::pop_heap(asked.begin(), asked.end(), std::greater<>());
      const uint32_t cell = asked.back().second;
      asked.pop_back();
      const Vector3d now = relaxed(cell, round);
      if (now != points_[cell].at[round]) {
        points_[cell].at[round] = now;
        askOthersAround(cell, round);
      }
      if (round == kRounds) setDown(cell);
    }
  }
}

void WoundWalls::findNormals() {
  for (const uint32_t vertex : to_shade_.list) {
    around_.clear();
    mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) {
      appendTo(around_, std::make_pair(mesh_.orderOf(triangle), triangle));
    });
    std::sort(around_.begin(), around_.end());
    Vector3d normal = Vector3d::Zero();
    for (const auto& [order, triangle] : around_) {
      const std::array<uint32_t, 3> v = mesh_.cornersOf(triangle);
      const Vector3d& at = vertices_[v[0]].point;
      normal += Vector3d((vertices_[v[1]].point - at).cross(vertices_[v[2]].point - at));
    }
    vertices_[vertex].normal =
        normal.squaredNorm() > 0 ? Vector3d(normal.stableNormalized()) : Vector3d(Vector3d::UnitZ());
    to_bind_.record(vertex, mark_);
  }
}

}  // namespace viscera
