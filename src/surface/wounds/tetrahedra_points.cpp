// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/tetrahedra_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "math/decompositions.h"
#include "surface/skins/keep_room.h"
#include "viscera/layout/links.h"

namespace viscera {

namespace {

// Of a spring: no lip is nearer to an end, as thinner pieces turn over when they are pulled.
constexpr double kNearest = 0.05;
constexpr double kEnd = 0.5;  // of the way through a face, from the edge that is crossed: where a wound ends

/// Weights of three corners for the point of their plane nearest to `at`, none below 0.
Vector3d weightsIn(const std::array<Vector3d, 3>& corners, const Vector3d& at) {
  const Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], d = at - corners[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), area = uu * vv - uv * uv;
  if (!(area > 0)) return Vector3d::UnitX();
  const double b = (vv * u.dot(d) - uv * v.dot(d)) / area, c = (uu * v.dot(d) - uv * u.dot(d)) / area;
  const Vector3d weights = Vector3d(1 - b - c, b, c).cwiseMax(0.0);
  return weights / weights.sum();
}

}  // namespace

TetrahedraPoints::TetrahedraPoints(const SpringNetwork& network, const TetrahedraIndex& index)
    : network_(network),
      index_(index),
      lips_(network.springs.size()),
      face_points_(index.faces.size()),
      known_(network.positions_m.size()) {}

void TetrahedraPoints::update(const layout::NodeBits* nodes, const float* spring_cut) {
  nodes_ = nodes;
  spring_cut_ = spring_cut;
  ++mark_;
  points_.clear();
  triangles_.clear();
  arounds_.clear();
  cut_.clear();
  for (uint32_t s = 0; s < network_.springs.size(); ++s) {
    if (!isCut(s)) continue;
    keepRoom(cut_, cut_.size() + 1);
    cut_.push_back(s);
  }
}

uint32_t TetrahedraPoints::cutEdges(const TetrahedraIndex::Tetrahedron& of) const {
  uint32_t bits = 0;
  for (size_t e = 0; e < 6; ++e) bits |= isCut(of.springs[e]) ? 1U << e : 0U;
  return bits;
}

/// From its end a. What was erased is cut in its middle: walls of a groove run half a spring from what is left.
double TetrahedraPoints::shareOf(uint32_t spring) const {
  const double cut = static_cast<double>(spring_cut_[spring]);
  return cut >= static_cast<double>(layout::kErasedShare) ? 0.5 : std::clamp(cut, kNearest, 1 - kNearest);
}

TetrahedraPoints::Point TetrahedraPoints::onSpring(uint32_t spring) const {
  const NetworkSpring& ends = network_.springs[spring];
  const double share = shareOf(spring);
  Point out;
  out.rest_m = at(ends.a) + share * (at(ends.b) - at(ends.a));
  out.depth_m =
      (1 - share) * static_cast<double>(index_.depth_m[ends.a]) + share * static_cast<double>(index_.depth_m[ends.b]);
  return out;
}

uint32_t TetrahedraPoints::add(const Point& point) {
  keepRoom(points_, points_.size() + 1);
  points_.push_back(point);
  return static_cast<uint32_t>(points_.size() - 1);
}

void TetrahedraPoints::carryBy(const std::array<uint32_t, 3>& slots, const Vector3d& weights, Point& point) const {
  point.slots = slots;
  point.weights = weights;
  point.offset_m = point.rest_m - (weights[0] * at(slots[0]) + weights[1] * at(slots[1]) + weights[2] * at(slots[2]));
}

uint32_t TetrahedraPoints::atNode(uint32_t slot) {
  Point point;
  point.rest_m = at(slot);
  point.depth_m = static_cast<double>(index_.depth_m[slot]);
  hangOn(slot, point);
  return add(point);
}

uint32_t TetrahedraPoints::lip(uint32_t spring, uint32_t slot) {
  const uint32_t side = network_.springs[spring].a == slot ? 0 : 1;
  if (lips_.marks[spring] != mark_) {
    lips_.marks[spring] = mark_;
    Point point = onSpring(spring);
    hangOn(network_.springs[spring].a, point);
    lips_.values[spring] = add(point);
    hangOn(network_.springs[spring].b, point);
    add(point);
  }
  return lips_.values[spring] + side;
}

uint32_t TetrahedraPoints::middle(uint32_t face, uint32_t slot, const std::array<uint32_t, 3>& springs) {
  const std::array<uint32_t, 3>& slots = index_.faces[face].slots;
  if (face_points_.marks[face] != mark_) {
    face_points_.marks[face] = mark_;
    Point point;
    std::array<uint32_t, 3> ordered = springs;
    std::sort(ordered.begin(), ordered.end());  // the same sum from either side
    for (const uint32_t spring : ordered) {
      const Point on = onSpring(spring);
      point.rest_m += on.rest_m / 3;
      point.depth_m += on.depth_m / 3;
    }
    face_points_.values[face] = static_cast<uint32_t>(points_.size());
    for (const uint32_t corner : slots) {
      hangOn(corner, point);
      add(point);
    }
  }
  return face_points_.values[face] + static_cast<uint32_t>(std::find(slots.begin(), slots.end(), slot) - slots.begin());
}

/// The normal of the plane through where the tetrahedra of some runs are cut; zero where there is too little of it, or
/// it is no plane.
template <class... Runs>
Vector3d TetrahedraPoints::normalOf(const Vector3d& near_m, Runs... runs) const {
  constexpr double kLine = 0.02, kFlat = 0.1;  // variances: less than that of the widest is a line; is as good as flat
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  const auto note = [&](uint32_t tetrahedron) {
    for (const uint32_t spring : index_.tetrahedra[tetrahedron].springs) {
      if (!isCut(spring)) continue;
      const Vector3d d = onSpring(spring).rest_m - near_m;
      mean += d;
      squares += d * d.transpose();
      ++count;
    }
  };
  (std::for_each(runs.first, runs.second, note), ...);
  mean /= count;
  const PrincipalAxes spread = principalAxesDirect(squares / count - mean * mean.transpose());
  const Vector3d variances = spread.values;
  if (!(variances[1] > kLine * variances[2]) || variances[0] > kFlat * variances[1]) return Vector3d::Zero();
  return spread.axes.col(0);
}

/// Across the wound where it cuts a spring, by the tetrahedra at it, or else by those at its ends.
Vector3d TetrahedraPoints::acrossWound(uint32_t spring) const {
  const auto run = [](const ItemRuns& runs, uint32_t key) {
    return std::make_pair(runs.items.begin() + runs.starts[key], runs.items.begin() + runs.starts[key + 1]);
  };
  const Vector3d near_m = onSpring(spring).rest_m;
  const Vector3d normal = normalOf(near_m, run(index_.of_spring, spring));
  if (!normal.isZero()) return normal;
  const NetworkSpring& ends = network_.springs[spring];
  return normalOf(near_m, run(index_.of_slot, ends.a), run(index_.of_slot, ends.b));
}

/// Where the wound would leave a face of which it crosses one edge: on a line through the face, or at its third corner.
TetrahedraPoints::Point TetrahedraPoints::exitOf(const Point& entry, uint32_t spring, uint32_t third) const {
  const NetworkSpring& ends = network_.springs[spring];
  const Vector3d across = acrossWound(spring);
  const double of_a = across.dot(at(ends.a) - entry.rest_m), of_b = across.dot(at(ends.b) - entry.rest_m);
  const double of_third = across.dot(at(third) - entry.rest_m);
  const bool beyond_a = of_third * of_a < 0;  // the line leaves by the edge from a to the third corner
  const double near = beyond_a ? of_a : of_b;
  const double share = of_a * of_b < 0 && of_third * near < 0 ? near / (near - of_third) : 1;
  const uint32_t end = beyond_a ? ends.a : ends.b;
  Point out;
  out.rest_m = at(end) + share * (at(third) - at(end));
  out.depth_m =
      (1 - share) * static_cast<double>(index_.depth_m[end]) + share * static_cast<double>(index_.depth_m[third]);
  return out;
}

uint32_t TetrahedraPoints::end(uint32_t face, uint32_t spring) {
  if (face_points_.marks[face] == mark_) return face_points_.values[face];
  face_points_.marks[face] = mark_;
  const std::array<uint32_t, 3>& slots = index_.faces[face].slots;
  const NetworkSpring& ends = network_.springs[spring];
  const uint32_t third =
      *std::find_if(slots.begin(), slots.end(), [&](uint32_t slot) { return slot != ends.a && slot != ends.b; });
  Point point = onSpring(spring);
  const Point exit = exitOf(point, spring, third);
  point.rest_m += kEnd * (exit.rest_m - point.rest_m);
  point.depth_m += kEnd * (exit.depth_m - point.depth_m);
  carryBy(slots, weightsIn({at(slots[0]), at(slots[1]), at(slots[2])}, point.rest_m), point);
  return face_points_.values[face] = add(point);
}

uint32_t TetrahedraPoints::onFace(const TetrahedraIndex::Tetrahedron& of, const WallVertex& vertex) {
  if (vertex.kind == WallVertex::kLip) return lip(of.springs[vertex.at], of.slots[vertex.corner]);
  const auto& corners = kTetrahedronFaces[vertex.at];
  std::array<uint32_t, 3> springs{};
  for (size_t i = 0; i < 3; ++i) springs[i] = of.springs[tetrahedronEdge(corners[i], corners[(i + 1) % 3])];
  const uint32_t face = of.faces[vertex.at];
  if (vertex.kind == WallVertex::kMiddle) return middle(face, of.slots[vertex.corner], springs);
  return end(face, *std::find_if(springs.begin(), springs.end(), [&](uint32_t spring) { return isCut(spring); }));
}

/// Mean of the points on edges and faces that the wound in a tetrahedron goes through.
void TetrahedraPoints::meanOfWound(const TetrahedraIndex::Tetrahedron& of, Point& mean) {
  int count = 0;
  const auto note = [&](const Point& point) {
    mean.rest_m += point.rest_m;
    mean.depth_m += point.depth_m;
    ++count;
  };
  for (const uint32_t spring : of.springs)
    if (isCut(spring)) note(onSpring(spring));
  for (uint8_t f = 0; f < 4; ++f) {
    const auto& c = kTetrahedronFaces[f];
    int cuts = 0;
    for (size_t i = 0; i < 3; ++i) cuts += isCut(of.springs[tetrahedronEdge(c[i], c[(i + 1) % 3])]) ? 1 : 0;
    if (cuts == 1) note(points_[onFace(of, {WallVertex::kEnd, f, c[0]})]);
    if (cuts == 3) note(points_[onFace(of, {WallVertex::kMiddle, f, c[0]})]);
  }
  mean.rest_m /= count;
  mean.depth_m /= count;
}

uint32_t TetrahedraPoints::centre(const TetrahedraIndex::Tetrahedron& of, const std::array<uint8_t, 4>& component,
                                  uint8_t which) {
  Point point;
  meanOfWound(of, point);
  std::array<uint32_t, 4> slots{};
  size_t count = 0;
  for (size_t corner = 0; corner < 4; ++corner)
    if (component[corner] == which) slots[count++] = of.slots[corner];
  if (count == 1) {
    hangOn(slots[0], point);
    return add(point);
  }
  if (count == 4) {  // without the corner that has least to say of it
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = at(slots[static_cast<size_t>(i) + 1]) - at(slots[0]);
    const Vector3d w = edges.fullPivLu().solve(point.rest_m - at(slots[0]));
    const std::array<double, 4> weights = {1 - w.sum(), w[0], w[1], w[2]};
    const auto least = std::min_element(weights.begin(), weights.end()) - weights.begin();
    std::swap(slots[static_cast<size_t>(least)], slots[3]);
    count = 3;
  }
  if (count == 2) {
    const Around& around = aroundOf(slots[0]);
    slots[2] = around.any == kNone ? slots[1] : around.any;
    for (uint32_t i = around.begin; i < around.end; ++i) {
      if (triangles_[i].slot1 == slots[1]) slots[2] = triangles_[i].slot2;
      if (triangles_[i].slot2 == slots[1]) slots[2] = triangles_[i].slot1;
    }
    const Vector3d along = at(slots[1]) - at(slots[0]);
    const double share = std::clamp(along.dot(point.rest_m - at(slots[0])) / along.squaredNorm(), 0.0, 1.0);
    carryBy({slots[0], slots[1], slots[2]}, {1 - share, share, 0}, point);
    return add(point);
  }
  carryBy({slots[0], slots[1], slots[2]}, weightsIn({at(slots[0]), at(slots[1]), at(slots[2])}, point.rest_m), point);
  return add(point);
}

/// The triangles of whole springs at a node, as edges from it; where there are none, pairs of whole springs.
void TetrahedraPoints::listTriangles(uint32_t slot) {
  constexpr double kLeastSine = 0.05;  // of the angle between two springs: less says nothing of how they turn
  size_t whole = 0;
  Around& around = arounds_.back();
  for (uint32_t i = index_.of_slot.starts[slot]; i < index_.of_slot.starts[slot + 1]; ++i) {
    const TetrahedraIndex::Tetrahedron& t = index_.tetrahedra[index_.of_slot.items[i]];
    const auto own = static_cast<size_t>(std::find(t.slots.begin(), t.slots.end(), slot) - t.slots.begin());
    for (size_t j = 0; j < 4; ++j) {
      if (j == own || isCut(t.springs[tetrahedronEdge(own, j)])) continue;
      if (around.any == kNone) around.any = t.slots[j];
      for (size_t k = j + 1; k < 4; ++k) {
        if (k == own || isCut(t.springs[tetrahedronEdge(own, k)])) continue;
        const bool is_whole = !isCut(t.springs[tetrahedronEdge(j, k)]);
        if (whole > 0 && !is_whole) continue;
        const Vector3d to_j = at(t.slots[j]) - at(slot), to_k = at(t.slots[k]) - at(slot);
        if (to_j.cross(to_k).norm() < kLeastSine * to_j.norm() * to_k.norm()) continue;
        if (whole == 0 && is_whole) triangles_.resize(around.begin);
        whole += is_whole ? 1 : 0;
        keepRoom(triangles_, triangles_.size() + 1);
        triangles_.push_back({t.slots[j], t.slots[k]});
      }
    }
  }
  around.end = static_cast<uint32_t>(triangles_.size());
}

const TetrahedraPoints::Around& TetrahedraPoints::aroundOf(uint32_t slot) {
  if (known_.marks[slot] != mark_) {
    known_.marks[slot] = mark_;
    known_.values[slot] = static_cast<uint32_t>(arounds_.size());
    keepRoom(arounds_, arounds_.size() + 1);
    arounds_.push_back({static_cast<uint32_t>(triangles_.size()), 0, kNone});
    listTriangles(slot);
  }
  return arounds_[known_.values[slot]];
}

/// Hangs a point on one node: it goes on as the triangle of whole springs at that node does whose plane it lies nearest
/// to, so that pieces of neighbours stay together where tissue shears.
void TetrahedraPoints::hangOn(uint32_t slot, Point& point) {
  constexpr double kFar = 0.3;  // what a whole edge of extrapolation counts beside as much out of the plane
  const Vector3d d = point.rest_m - at(slot);
  const Around& around = aroundOf(slot);
  const uint32_t any = around.any == kNone ? slot : around.any;
  std::array<uint32_t, 3> slots = {slot, any, any};
  Vector3d weights = Vector3d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t i = around.begin; i < around.end; ++i) {
    const Vector3d u = at(triangles_[i].slot1) - at(slot), v = at(triangles_[i].slot2) - at(slot);
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), ud = u.dot(d), vd = v.dot(d), area = uu * vv - uv * uv;
    const double b = (vv * ud - uv * vd) / area, c = (uu * vd - uv * ud) / area;
    const double off = (d - b * u - c * v).norm() / d.norm() + kFar * (std::abs(b) + std::abs(c));
    if (!(off < least)) continue;
    least = off;
    slots = {slot, triangles_[i].slot1, triangles_[i].slot2};
    weights = {1 - b - c, b, c};
  }
  carryBy(slots, weights, point);
}

}  // namespace viscera
