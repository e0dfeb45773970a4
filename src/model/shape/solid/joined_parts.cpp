// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/joined_parts.h"

#include <algorithm>
#include <tuple>

#include "math/union_find.h"
#include "model/shape/solid/triangle_sides.h"

namespace viscera {
namespace {

using Point = std::array<float, 3>;

/// Edge that an odd number of a part's triangles share.
struct OpenEdge {
  Point low, high;  ///< low < high
  uint32_t low_vertex, high_vertex;
  uint16_t part;

  bool meets(const OpenEdge& other) const { return low == other.low && high == other.high; }
};

Point pointOf(const Vector3f& p) {
  return {p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};  // -0 becomes 0
}

void addOpenEdges(const TriangleMesh& mesh, const std::vector<uint32_t>& of_part, uint16_t part,
                  std::vector<OpenEdge>& edges) {
  std::vector<std::array<uint32_t, 3>> triangles;
  triangles.reserve(of_part.size());
  for (const uint32_t t : of_part) triangles.push_back(mesh.triangles[t]);
  const std::vector<Side> sides = sortedSides(triangles);
  forEachEdge(sides, [&](size_t first, size_t last) {
    if ((last - first) % 2 == 0) return;
    OpenEdge edge{pointOf(mesh.positions_m[sides[first].low]), pointOf(mesh.positions_m[sides[first].high]),
                  sides[first].low, sides[first].high, part};
    if (edge.high < edge.low) {
      std::swap(edge.low, edge.high);
      std::swap(edge.low_vertex, edge.high_vertex);
    }
    edges.push_back(edge);
  });
}

/// Parts with common borders, and the vertices of these borders.
class Joins {
 public:
  explicit Joins(const TriangleMesh& mesh)
      : of_parts(trianglesByPart(mesh)), groups(of_parts.size()), vertices(mesh.positions_m.size()) {
    if (of_parts.size() < 2) return;
    std::vector<OpenEdge> edges;
    for (size_t part = 0; part < of_parts.size(); ++part) {
      addOpenEdges(mesh, of_parts[part], static_cast<uint16_t>(part), edges);
    }
    std::sort(edges.begin(), edges.end(), [](const OpenEdge& a, const OpenEdge& b) {
      return std::tie(a.low, a.high, a.part) < std::tie(b.low, b.high, b.part);
    });
    for (size_t i = 1; i < edges.size(); ++i) {
      if (edges[i].meets(edges[i - 1])) join(edges[i - 1], edges[i]);
    }
  }

  std::vector<std::vector<uint32_t>> of_parts;
  UnionFind groups;    ///< sets of joined parts
  UnionFind vertices;  ///< sets of vertices that meet

 private:
  void join(const OpenEdge& a, const OpenEdge& b) {
    groups.unite(a.part, b.part);
    vertices.unite(a.low_vertex, b.low_vertex);
    vertices.unite(a.high_vertex, b.high_vertex);
  }
};

}  // namespace

std::vector<double> partAreas(const TriangleMesh& mesh) {
  std::vector<double> areas_m2(mesh.part_names.size(), 0);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const Vector3d a = mesh.positions_m[corners[0]].cast<double>();
    const Vector3d ab = mesh.positions_m[corners[1]].cast<double>() - a;
    areas_m2[mesh.parts[t]] += 0.5 * ab.cross(mesh.positions_m[corners[2]].cast<double>() - a).norm();
  }
  return areas_m2;
}

std::vector<ClosedSurface> closeSurfaces(const TriangleMesh& mesh) {
  Joins joins(mesh);
  std::vector<std::vector<size_t>> groups(joins.of_parts.size());
  for (uint32_t part = 0; part < groups.size(); ++part) {
    if (!joins.of_parts[part].empty()) groups[joins.groups.find(part)].push_back(part);
  }
  const std::vector<uint32_t> vertices = std::move(joins.vertices).all();
  const std::vector<double> areas_m2 = partAreas(mesh);
  const auto smaller = [&](size_t a, size_t b) { return areas_m2[a] < areas_m2[b]; };
  std::vector<ClosedSurface> out;
  for (const std::vector<size_t>& group : groups) {
    if (group.size() > 1) {
      std::vector<uint32_t> triangles;
      for (const size_t part : group) {
        triangles.insert(triangles.end(), joins.of_parts[part].begin(), joins.of_parts[part].end());
      }
      std::sort(triangles.begin(), triangles.end());
      Shell shell = closePart(mesh, triangles, vertices);
      if (!shell.isOpenSheet()) {
        const auto part = static_cast<uint16_t>(*std::max_element(group.begin(), group.end(), smaller));
        out.push_back({std::move(shell), std::move(triangles), part, true});
        continue;
      }
    }
    for (const size_t part : group) {
      Shell shell = closePart(mesh, joins.of_parts[part]);
      out.push_back({std::move(shell), std::move(joins.of_parts[part]), static_cast<uint16_t>(part), false});
    }
  }
  return out;
}

}  // namespace viscera
