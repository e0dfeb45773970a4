// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/shape/mesh/triangle_tree.h"
#include "viscera/model/model.h"
#include "viscera/surface/skin_marks.h"

namespace viscera {

/// Surface mesh of one body at rest, with vertices numbered as in VisibleMesh.
class RestSkin {
 public:
  /// @param body  must outlive this   @param first_vertex  number of its first vertex
  RestSkin(const Body& body, uint32_t first_vertex);

  /// Returns the nearest point on the surface [m].
  MeshPoint nearest(const Vector3d& point_m) const { return tree_.nearest(point_m.cast<float>()); }
  /// Returns the point to which a mark's point is moved: along the normal to a surface that faces it, at most
  /// `within_m` away, or else the nearest point. @param normal  of any length; 0: the nearest point
  SkinPoint onto(const Vector3d& point_m, const Vector3d& normal, double within_m) const;
  /// Returns the pieces of the surface's section by a plane, within a distance of its origin; two points each.
  std::vector<std::pair<SkinPoint, SkinPoint>> section(const Vector3d& origin_m, const Vector3d& normal,
                                                       double within_m) const;
  Vector3d normalAt(const SkinPoint& point) const;  ///< of its triangle, unit
  double edge_m() const { return edge_m_; }         ///< mean length of edges [m]

 private:
  SkinPoint pointOf(const MeshPoint& position) const;
  Vector3f fromCorner(const SkinPoint& point) const;
  Vector3f corner(uint32_t vertex) const { return body_.skin.mesh.positions_m[vertex - first_vertex_]; }

  const Body& body_;
  const uint32_t first_vertex_;
  const TriangleTree tree_;
  double edge_m_ = 0;
};

/// Surface meshes of all bodies of a model at rest.
class RestSkins {
 public:
  explicit RestSkins(const Model& model);
  /// Returns the number of the body of that name, or of the one nearest to a point if the name is empty.
  size_t bodyOf(const std::string& name, const Vector3d& point_m) const;
  const RestSkin& operator[](size_t body) const { return skins_[body]; }

 private:
  const Model& model_;
  std::vector<RestSkin> skins_;
};

}  // namespace viscera
