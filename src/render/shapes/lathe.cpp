// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/lathe.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {
constexpr uint32_t kSegments = 32;  // around z
constexpr int kArcSteps = 12;       // per arc
constexpr float kQuarterTurn = static_cast<float>(M_PI / 2);
}  // namespace

Profile& Profile::line(float radius_from, float z_from, float radius_to, float z_to) {
  const float rise = z_to - z_from, widening = radius_to - radius_from;
  const float length = std::hypot(rise, widening);
  points_.push_back({radius_from, z_from, rise / length, -widening / length});
  points_.push_back({radius_to, z_to, rise / length, -widening / length});
  return *this;
}

Profile& Profile::arc(float radius, float z_center, float angle_from, float angle_to) {
  for (int step = 0; step <= kArcSteps; ++step) {
    const float angle = angle_from + (angle_to - angle_from) * static_cast<float>(step) / kArcSteps;
    const float out = std::max(std::cos(angle), 0.0f);  // at a pole it rounds to either side of 0
    points_.push_back({radius * out, z_center + radius * std::sin(angle), out, std::sin(angle)});
  }
  return *this;
}

Profile sphereProfile(float radius) {
  return Profile().arc(radius, 0, -kQuarterTurn, 0).arc(radius, 0, 0, kQuarterTurn);
}

void addLathe(const Profile& profile, const Eigen::Affine3f& placement, const std::array<uint8_t, 4>& color,
              ToolShape& shape) {
  const Eigen::Matrix3f normal_matrix = placement.linear().inverse().transpose();
  const uint32_t first = static_cast<uint32_t>(shape.vertices.size());
  for (const Profile::Point& point : profile.points()) {
    for (uint32_t i = 0; i < kSegments; ++i) {
      const float turn = static_cast<float>(2 * M_PI * i / kSegments), c = std::cos(turn), s = std::sin(turn);
      const Vector3f p = placement * Vector3f(point.radius * c, point.radius * s, point.z);
      const Vector3f n =
          (normal_matrix * Vector3f(point.normal_radius * c, point.normal_radius * s, point.normal_z)).normalized();
      shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, color});
    }
  }
  for (uint32_t ring = 0; ring + 1 < profile.points().size(); ++ring) {
    for (uint32_t i = 0; i < kSegments; ++i) {
      const uint32_t a = first + ring * kSegments + i, b = first + ring * kSegments + (i + 1) % kSegments;
      for (uint32_t index : {a, b, b + kSegments, a, b + kSegments, a + kSegments}) shape.indices.push_back(index);
    }
  }
}

}  // namespace viscera
