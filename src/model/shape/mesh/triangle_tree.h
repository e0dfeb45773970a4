// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Point on a mesh.
struct MeshPoint {
  uint32_t triangle = kNone;
  Vector3f weights = Vector3f::Zero();  ///< barycentric weights of the triangle's corners
  float distance_m = std::numeric_limits<float>::infinity();

  static constexpr uint32_t kNone = UINT32_MAX;
  bool found() const { return triangle != kNone; }
};

/// Bounding volume hierarchy over the triangles of a mesh, for proximity and ray queries.
class TriangleTree {
 public:
  /// @param mesh  is copied
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Returns the nearest point on the mesh, if one is nearer than `within_m`.
  MeshPoint nearest(const Vector3f& point_m, float within_m = std::numeric_limits<float>::infinity()) const;
  /// Returns the nearest point on the line through a point, at most `within_m` away in either direction, on a triangle
  /// that faces along `direction`.
  /// @param direction  unit
  MeshPoint along(const Vector3f& point_m, const Vector3f& direction, float within_m) const;
  /// Returns the first point ahead on a triangle that faces along `direction`, if there is one.
  MeshPoint ahead(const Vector3f& point_m, const Vector3f& direction) const;

 private:
  struct Node {
    Vector3f low, high;
    uint32_t first = 0;  ///< index of its first triangle, or of its second child; the first child follows it
    uint32_t count = 0;  ///< number of triangles; 0: it has children
  };
  struct Corners {
    Vector3f a, ab, ac;
    uint32_t triangle;
  };
  void build(size_t first, size_t last);
  MeshPoint onLine(const Vector3f& point_m, const Vector3f& direction, float within_m, bool both_directions) const;

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
};

}  // namespace viscera
