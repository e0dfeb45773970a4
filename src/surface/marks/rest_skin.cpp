// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/marks/rest_skin.h"

#include <array>
#include <limits>

namespace viscera {

RestSkin::RestSkin(const Body& body, uint32_t first_vertex)
    : body_(body), first_vertex_(first_vertex), tree_(body.skin.mesh) {
  const TriangleMesh& mesh = body.skin.mesh;
  for (const auto& triangle : mesh.triangles)
    for (size_t i = 0; i < 3; ++i)
      edge_m_ += static_cast<double>((mesh.positions_m[triangle[i]] - mesh.positions_m[triangle[(i + 1) % 3]]).norm());
  edge_m_ /= 3 * static_cast<double>(std::max<size_t>(1, mesh.triangles.size()));
}

SkinPoint RestSkin::pointOf(const MeshPoint& position) const {
  SkinPoint out;
  if (!position.found()) return out;
  for (size_t i = 0; i < 3; ++i) {
    out.vertices[i] = first_vertex_ + body_.skin.mesh.triangles[position.triangle][i];
    out.rest_m += position.weights[static_cast<Eigen::Index>(i)] * corner(out.vertices[i]);
  }
  out.weights = position.weights;
  out.off_corner_m = fromCorner(out);
  return out;
}

SkinPoint RestSkin::onto(const Vector3d& point_m, const Vector3d& normal, double within_m) const {
  if (!normal.isZero()) {
    const MeshPoint ahead =
        tree_.along(point_m.cast<float>(), normal.normalized().cast<float>(), static_cast<float>(within_m));
    if (ahead.found()) return pointOf(ahead);
  }
  return pointOf(nearest(point_m));
}

Vector3f RestSkin::fromCorner(const SkinPoint& point) const {
  Eigen::Index heaviest = 0;
  point.weights.maxCoeff(&heaviest);
  return point.rest_m - corner(point.vertices[static_cast<size_t>(heaviest)]);
}

std::vector<std::pair<SkinPoint, SkinPoint>> RestSkin::section(const Vector3d& origin_m, const Vector3d& normal,
                                                               double within_m) const {
  const Vector3f origin = origin_m.cast<float>(), up = normal.normalized().cast<float>();
  const auto within = static_cast<float>(within_m);
  std::vector<std::pair<SkinPoint, SkinPoint>> out;
  for (const auto& triangle : body_.skin.mesh.triangles) {
    std::array<SkinPoint, 3> met;
    size_t count = 0;
    for (size_t i = 0; i < 3 && count < 2; ++i) {
      SkinPoint point;
      for (size_t k = 0; k < 3; ++k) point.vertices[k] = first_vertex_ + triangle[k];
      const size_t next = (i + 1) % 3;
      const Vector3f a = corner(point.vertices[i]) - origin, b = corner(point.vertices[next]) - origin;
      const float from = up.dot(a), to = up.dot(b);
      if ((from < 0) == (to < 0)) continue;
      const float share = from / (from - to);
      point.weights[static_cast<Eigen::Index>(i)] = 1 - share;
      point.weights[static_cast<Eigen::Index>(next)] = share;
      point.rest_m = origin + (1 - share) * a + share * b;
      point.off_corner_m = fromCorner(point);
      if ((point.rest_m - origin).norm() <= within) met[count++] = point;
    }
    if (count == 2) out.emplace_back(met[0], met[1]);
  }
  return out;
}

Vector3d RestSkin::normalAt(const SkinPoint& point) const {
  const Vector3f a = corner(point.vertices[0]);
  return (corner(point.vertices[1]) - a).cross(corner(point.vertices[2]) - a).cast<double>().normalized();
}

RestSkins::RestSkins(const Model& model) : model_(model) {
  uint32_t vertex = 0;
  for (const Body& body : model.bodies) {
    skins_.emplace_back(body, vertex);
    vertex += static_cast<uint32_t>(body.skin.bindings.size() + 2 * body.skin.split_edges.size());
  }
}

size_t RestSkins::bodyOf(const std::string& name, const Vector3d& point_m) const {
  size_t out = 0;
  float nearest_m = std::numeric_limits<float>::infinity();
  for (size_t b = 0; b < skins_.size(); ++b) {
    if (!name.empty() && model_.bodies[b].name == name) return b;
    const MeshPoint position = skins_[b].nearest(point_m);
    if (!name.empty() || position.distance_m >= nearest_m) continue;
    nearest_m = position.distance_m;
    out = b;
  }
  return out;
}

}  // namespace viscera
