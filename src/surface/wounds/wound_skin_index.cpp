// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_skin_index.h"

#include <algorithm>
#include <utility>

namespace viscera {

void NumberLists::fill(std::vector<std::array<uint32_t, 2>> pairs, size_t count) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  starts.assign(count + 1, 0);
  values.clear();
  for (const auto& [list, value] : pairs) {
    ++starts[list + 1];
    values.push_back(value);
  }
  for (size_t i = 1; i <= count; ++i) starts[i] += starts[i - 1];
}

WoundSkinIndex::WoundSkinIndex(const Skin& skin, const Lattice& lattice) : normals(vertexNormals(skin.mesh)) {
  const CutCells whole(lattice);
  for (const Vector3f& at : skin.mesh.positions_m) {
    points.push_back((at.cast<double>() - lattice.origin_m) / lattice.spacing_m);
    positions.push_back(whole.positionOf(points.back()));
  }
  addEdges(skin.mesh);
  listCells(skin.mesh, whole, lattice.nodes.size());
  std::vector<std::array<uint32_t, 2>> bound;
  for (uint32_t v = 0; v < skin.bindings.size(); ++v) {
    bound.push_back({skin.bindings[v].slot0, v});
    bound.push_back({skin.bindings[v].slot2, v});
  }
  of_slots.fill(std::move(bound), lattice.nodes.size());
}

void WoundSkinIndex::addEdges(const TriangleMesh& mesh) {
  struct Side {
    uint32_t a, b, position;  // of 3 * triangles
  };
  std::vector<Side> sides;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), 3 * t + i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::array<uint32_t, 3>{x.a, x.b, x.position} < std::array<uint32_t, 3>{y.a, y.b, y.position};
  });
  triangle_edges.resize(mesh.triangles.size());
  for (const Side& side : sides) {
    if (edges.empty() || edges.back() != std::array<uint32_t, 2>{side.a, side.b}) {
      edges.push_back({side.a, side.b});
      edge_triangles.push_back({side.position / 3, kNone});
    } else if (edge_triangles.back()[1] == kNone) {
      edge_triangles.back()[1] = side.position / 3;
    }
    triangle_edges[side.position / 3][side.position % 3] = static_cast<uint32_t>(edges.size() - 1);
  }
}

void WoundSkinIndex::listCells(const TriangleMesh& mesh, const CutCells& whole, size_t slots) {
  std::vector<std::array<uint32_t, 2>> touched;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const Vector3d &a = points[corners[0]], &b = points[corners[1]], &c = points[corners[2]];
    for (const Vector3d& at :
         {a, b, c, Vector3d((a + b) / 2), Vector3d((b + c) / 2), Vector3d((c + a) / 2), Vector3d((a + b + c) / 3)})
      touched.push_back({whole.positionOf(at).cell, t});
    longest = std::max({longest, (b - a).norm(), (c - b).norm(), (a - c).norm()});
  }
  std::vector<std::array<uint32_t, 2>> cells;
  cells.reserve(touched.size());
  for (const auto& [cell, t] : touched) cells.push_back({t, cell});
  cells_of.fill(std::move(cells), mesh.triangles.size());
  of_cells.fill(std::move(touched), slots);
}

}  // namespace viscera
