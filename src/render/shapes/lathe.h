// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "render/shapes/tool_shape.h"

namespace viscera {

/// Outline of a surface of revolution about z, from its lowest z to its highest. Pieces that meet with different
/// normals make a sharp edge.
class Profile {
 public:
  /// Adds a straight piece. Radii and heights in metres.
  Profile& line(float radius_from, float z_from, float radius_to, float z_to);
  /// Adds a piece of a circle about (0, z_center); angles from the equator [rad], -pi/2 is the lowest point.
  Profile& arc(float radius, float z_center, float angle_from, float angle_to);

  struct Point {
    float radius, z, normal_radius, normal_z;
  };
  const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
};

Profile sphereProfile(float radius);

/// Turns a profile about z, places the result and appends its triangles to a shape.
void addLathe(const Profile& profile, const Eigen::Affine3f& placement, const std::array<uint8_t, 4>& color,
              ToolShape& shape);

}  // namespace viscera
