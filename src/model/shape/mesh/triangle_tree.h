// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// A place on a mesh.
struct MeshPlace {
  uint32_t triangle = kNone;
  Vector3f weights = Vector3f::Zero();  ///< barycentric, of the triangle's corners
  float distance_m = std::numeric_limits<float>::infinity();

  static constexpr uint32_t kNone = UINT32_MAX;
  bool found() const { return triangle != kNone; }
};

/// Triangles of a mesh in boxes within boxes, for questions of where.
class TriangleTree {
 public:
  /// @param mesh  is copied from
  explicit TriangleTree(const TriangleMesh& mesh);

  /// The nearest place on the mesh, if one is nearer than `within_m`.
  MeshPlace nearest(const Vector3f& point_m, float within_m = std::numeric_limits<float>::infinity()) const;
  /// The place nearest to the point on the line through it, no farther than `within_m` on either hand, on a triangle
  /// whose front faces along `direction`.
  /// @param direction  unit
  MeshPlace along(const Vector3f& point_m, const Vector3f& direction, float within_m) const;
  /// Returns the first place ahead of the point whose front faces along `direction`, if there is one.
  MeshPlace ahead(const Vector3f& point_m, const Vector3f& direction) const;

 private:
  struct Node {
    Vector3f low, high;
    uint32_t first = 0;  ///< of its triangles, or its second child; the first one follows it
    uint32_t count = 0;  ///< of triangles; 0: it has children
  };
  struct Corners {
    Vector3f a, ab, ac;
    uint32_t triangle;
  };
  void build(size_t first, size_t last);
  MeshPlace onLine(const Vector3f& point_m, const Vector3f& direction, float within_m, bool both_ways) const;

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
};

}  // namespace viscera
