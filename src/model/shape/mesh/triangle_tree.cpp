// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/mesh/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace viscera {

namespace {

constexpr size_t kMostInLeaf = 4;
constexpr size_t kDeepest = 64;  // halvings of 2^64 triangles

float distance2ToBox(const Vector3f& p, const Vector3f& low, const Vector3f& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.F).squaredNorm();
}

/// Returns the weights of b and c of the point of a triangle that is nearest to `ap` from its corner a
/// (Ericson, 5.1.5).
std::array<float, 2> nearestWeights(const Vector3f& ab, const Vector3f& ac, const Vector3f& ap) {
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const Vector3f bp = ap - ab, cp = ap - ac;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const float sum = va + vb + vc;
  if (!(sum > 0)) return {0, 0};  // no area
  return {vb / sum, vc / sum};
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const Vector3f& a = mesh.positions_m[v[0]];
    corners_.push_back({a, mesh.positions_m[v[1]] - a, mesh.positions_m[v[2]] - a, t});
  }
  if (!corners_.empty()) build(0, corners_.size());
}

void TriangleTree::build(size_t first, size_t last) {
  Eigen::AlignedBox3f box, middles;
  const auto middle = [](const Corners& c) -> Vector3f { return c.a + (c.ab + c.ac) / 3; };
  for (size_t i = first; i < last; ++i) {
    const Corners& c = corners_[i];
    box.extend(c.a);
    box.extend(Vector3f(c.a + c.ab));
    box.extend(Vector3f(c.a + c.ac));
    middles.extend(middle(c));
  }
  const size_t own = nodes_.size();
  nodes_.push_back({box.min(), box.max(), static_cast<uint32_t>(first), static_cast<uint32_t>(last - first)});
  if (last - first <= kMostInLeaf) return;
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const size_t half = first + (last - first) / 2;
  const auto at = [&](size_t i) { return corners_.begin() + static_cast<ptrdiff_t>(i); };
  std::nth_element(at(first), at(half), at(last),
                   [&](const Corners& a, const Corners& b) { return middle(a)[axis] < middle(b)[axis]; });
  nodes_[own].count = 0;
  build(first, half);
  nodes_[own].first = static_cast<uint32_t>(nodes_.size());
  build(half, last);
}

MeshPoint TriangleTree::nearest(const Vector3f& point_m, float within_m) const {
  MeshPoint best;
  float best2 = within_m < 1e18F ? within_m * within_m : std::numeric_limits<float>::infinity();
  std::array<uint32_t, kDeepest> waiting;
  size_t count = nodes_.empty() ? 0 : 1;
  waiting[0] = 0;
  while (count > 0) {
    const uint32_t index = waiting[--count];
    const Node& node = nodes_[index];
    if (distance2ToBox(point_m, node.low, node.high) >= best2) continue;
    if (node.count == 0) {
      uint32_t near = index + 1, far = node.first;
      if (distance2ToBox(point_m, nodes_[far].low, nodes_[far].high) <
          distance2ToBox(point_m, nodes_[near].low, nodes_[near].high))
        std::swap(near, far);
      waiting[count++] = far;
      waiting[count++] = near;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Corners& c = corners_[i];
      const auto [v, w] = nearestWeights(c.ab, c.ac, point_m - c.a);
      const float distance2 = (point_m - c.a - v * c.ab - w * c.ac).squaredNorm();
      if (distance2 >= best2) continue;
      best2 = distance2;
      best = {c.triangle, Vector3f(1 - v - w, v, w), std::sqrt(distance2)};
    }
  }
  return best;
}

MeshPoint TriangleTree::along(const Vector3f& point_m, const Vector3f& direction, float within_m) const {
  return onLine(point_m, direction, within_m, true);
}

MeshPoint TriangleTree::ahead(const Vector3f& point_m, const Vector3f& direction) const {
  return onLine(point_m, direction, std::numeric_limits<float>::infinity(), false);
}

MeshPoint TriangleTree::onLine(const Vector3f& point_m, const Vector3f& direction, float within_m,
                               bool both_directions) const {
  MeshPoint best;
  best.distance_m = within_m;
  const auto meets = [&](const Node& node) {
    float from = both_directions ? -best.distance_m : 0, to = best.distance_m;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = node.low[axis] - point_m[axis], high = node.high[axis] - point_m[axis];
      if (std::abs(direction[axis]) < 1e-12F) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const float a = low / direction[axis], b = high / direction[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from <= to;
  };
  std::array<uint32_t, kDeepest> waiting;
  size_t count = nodes_.empty() ? 0 : 1;
  waiting[0] = 0;
  while (count > 0) {
    const uint32_t index = waiting[--count];
    const Node& node = nodes_[index];
    if (!meets(node)) continue;
    if (node.count == 0) {
      waiting[count++] = node.first;
      waiting[count++] = index + 1;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Corners& c = corners_[i];
      const float facing = c.ab.cross(c.ac).dot(direction);
      if (!(facing > 0)) continue;
      const Vector3f ap = point_m - c.a;
      const float t = -c.ab.cross(c.ac).dot(ap) / facing;
      const Vector3f turned = direction.cross(ap);
      const float v = c.ac.dot(turned) / facing, w = -c.ab.dot(turned) / facing;
      if (v < 0 || w < 0 || v + w > 1 || std::abs(t) >= best.distance_m || (t <= 0 && !both_directions)) continue;
      best = {c.triangle, Vector3f(1 - v - w, v, w), std::abs(t)};
    }
  }
  return best.found() ? best : MeshPoint();
}

}  // namespace viscera
