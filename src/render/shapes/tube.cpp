// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/tube.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace viscera {

namespace {

/// Returns the directions of the sides, as cosine and sine.
std::array<Eigen::Vector2f, kTubeSides> turns() {
  std::array<Eigen::Vector2f, kTubeSides> out;
  for (size_t j = 0; j < kTubeSides; ++j) {
    const double angle = 2 * M_PI * static_cast<double>(j) / static_cast<double>(kTubeSides);
    out[j] = Eigen::Vector2f(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
  }
  return out;
}

std::array<float, 3> arrayOf(const Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

void addTube(const std::vector<Vector3f>& points_m, const std::vector<float>& radii_m,
             const std::array<uint8_t, 4>& color, ToolShape& shape) {
  static const std::array<Eigen::Vector2f, kTubeSides> kTurns = turns();
  if (points_m.empty()) return;
  const auto first = static_cast<uint32_t>(shape.vertices.size());
  const size_t last = points_m.size() - 1;
  Vector3f along = Vector3f::UnitZ(), side = Vector3f::UnitX();
  const auto addRing = [&](size_t i, bool end) {  // rings of ends have no width, and close the tube
    const Vector3f across = along.cross(side);
    for (const Eigen::Vector2f& turn : kTurns) {
      const Vector3f out = turn.x() * side + turn.y() * across;
      const Vector3f normal = !end ? out : Vector3f(i == 0 ? -along : along);
      shape.vertices.push_back({arrayOf(end ? points_m[i] : points_m[i] + radii_m[i] * out), arrayOf(normal), color});
    }
  };
  for (size_t i = 0; i <= last; ++i) {
    const Vector3f offset = points_m[std::min(i + 1, last)] - points_m[i == 0 ? 0 : i - 1];
    if (offset.squaredNorm() > 0) along = offset.normalized();
    // Transports the direction of the side along the bend, without twist.
    side -= along.dot(side) * along;
    side = side.squaredNorm() > 1e-6f ? Vector3f(side.normalized()) : along.unitOrthogonal();
    if (i == 0) addRing(i, true);
    addRing(i, false);
    if (i == last) addRing(i, true);
  }
  constexpr auto kSides = static_cast<uint32_t>(kTubeSides);
  for (uint32_t ring = 0; ring < last + 2; ++ring) {
    for (uint32_t j = 0; j < kSides; ++j) {
      const uint32_t a = first + ring * kSides + j, b = first + ring * kSides + (j + 1) % kSides;
      for (const uint32_t index : {a, b, b + kSides, a, b + kSides, a + kSides}) shape.indices.push_back(index);
    }
  }
  shape.solid_indices = shape.indices.size();
}

}  // namespace viscera
