// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/tetrahedra_mesh.h"

#include <limits>

namespace viscera {
namespace {

/// Corners of a cell, a bit per axis, of the five tetrahedra of an even cell; odd cells are mirrored in x.
constexpr uint32_t kInEvenCell[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 3, 0, 6}, {4, 5, 6, 0}, {7, 6, 5, 3}};

std::array<uint32_t, 4> facingPositive(const TetrahedraMesh& mesh, std::array<uint32_t, 4> tetrahedron) {
  if (signedVolume(mesh, tetrahedron) < 0) std::swap(tetrahedron[2], tetrahedron[3]);
  return tetrahedron;
}

/// Vertices at the corners of a solid's cells, each made once.
class CornerVertices {
 public:
  CornerVertices(const Solid& solid, TetrahedraMesh& mesh)
      : solid_(solid),
        mesh_(mesh),
        known_(static_cast<size_t>((solid.cells.array() + 1).cast<int64_t>().prod()), kNone) {}

  uint32_t at(const Vector3i& node) {
    const auto row = static_cast<size_t>(solid_.cells.x()) + 1,
               layer = row * (static_cast<size_t>(solid_.cells.y()) + 1);
    uint32_t& vertex = known_[static_cast<size_t>(node.x()) + row * static_cast<size_t>(node.y()) +
                              layer * static_cast<size_t>(node.z())];
    if (vertex == kNone) {
      vertex = static_cast<uint32_t>(mesh_.positions_m.size());
      mesh_.positions_m.push_back(solid_.origin_m + solid_.spacing_m * node.cast<double>());
    }
    return vertex;
  }

 private:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  const Solid& solid_;
  TetrahedraMesh& mesh_;
  std::vector<uint32_t> known_;
};

}  // namespace

double signedVolume(const TetrahedraMesh& mesh, const std::array<uint32_t, 4>& tetrahedron) {
  const Vector3d& o = mesh.positions_m[tetrahedron[0]];
  const Vector3d a = mesh.positions_m[tetrahedron[1]] - o, b = mesh.positions_m[tetrahedron[2]] - o,
                 c = mesh.positions_m[tetrahedron[3]] - o;
  return a.dot(b.cross(c)) / 6;
}

TetrahedraMesh tetrahedraOf(const Solid& solid) {
  TetrahedraMesh mesh;
  CornerVertices vertices(solid, mesh);
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.label(x, y, z) == 0) continue;
        const uint32_t mirror = static_cast<uint32_t>(x + y + z) % 2;
        for (const auto& corners : kInEvenCell) {
          std::array<uint32_t, 4> tetrahedron;
          for (size_t c = 0; c < 4; ++c) {
            const uint32_t corner = corners[c] ^ mirror;
            const Vector3i offset(corner & 1, corner >> 1 & 1, corner >> 2);
            tetrahedron[c] = vertices.at(Vector3i(x, y, z) + offset);
          }
          mesh.tetrahedra.push_back(facingPositive(mesh, tetrahedron));
        }
      }
    }
  }
  return mesh;
}

}  // namespace viscera
