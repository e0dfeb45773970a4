// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/obstacle_shape.h"

#include <cmath>

#include "render/shapes/lathe.h"

namespace viscera {

namespace {

constexpr std::array<uint8_t, 4> kObstacleColor = {104, 118, 132, 255};  // slate, unlike tissue and tools
constexpr float kObstacleQuarterTurn = static_cast<float>(M_PI / 2);

/// Adds a rectangle around `middle`, counter-clockwise seen from where u x v points.
void addRectangle(const Vector3f& middle, const Vector3f& u, const Vector3f& v, ToolShape& shape) {
  const Vector3f normal = u.cross(v).normalized();
  const uint32_t first = static_cast<uint32_t>(shape.vertices.size());
  for (const auto& [s, t] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
    const Vector3f p = middle + s * u + t * v;
    shape.vertices.push_back({{p.x(), p.y(), p.z()}, {normal.x(), normal.y(), normal.z()}, kObstacleColor});
  }
  for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) shape.indices.push_back(first + corner);
}

void addBox(const Vector3f& half, ToolShape& shape) {
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (const float side : {-1.0f, 1.0f}) {
      const Vector3f u = half[next] * Vector3f::Unit(next), v = side * half[last] * Vector3f::Unit(last);
      addRectangle(side * half[axis] * Vector3f::Unit(axis), u, v, shape);
    }
  }
}

void addCapsule(float radius, float length, ToolShape& shape) {
  const float z = 0.5f * length;
  const Profile capsule = Profile()
                              .arc(radius, -z, -kObstacleQuarterTurn, 0)
                              .line(radius, -z, radius, z)
                              .arc(radius, z, 0, kObstacleQuarterTurn);
  addLathe(capsule, Eigen::Affine3f::Identity(), kObstacleColor, shape);
}

}  // namespace

ToolShape obstacleShape(const ObstacleConfig& obstacle) {
  ToolShape shape;
  const float radius = static_cast<float>(obstacle.radius_m), half_plane = 0.5f * static_cast<float>(kDrawnPlane_m);
  switch (obstacle.shape) {
    case ObstacleShape::kPlane:
      addRectangle(Vector3f::Zero(), half_plane * Vector3f::UnitX(), half_plane * Vector3f::UnitY(), shape);
      break;
    case ObstacleShape::kSphere:
      addLathe(sphereProfile(radius), Eigen::Affine3f::Identity(), kObstacleColor, shape);
      break;
    case ObstacleShape::kCapsule:
      addCapsule(radius, static_cast<float>(obstacle.length_m), shape);
      break;
    case ObstacleShape::kBox:
      addBox(Vector3f((0.5 * obstacle.size_m).cast<float>()), shape);
      break;
  }
  shape.solid_indices = shape.indices.size();
  return shape;
}

}  // namespace viscera
