// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/mesh/box_surface.h"

#include <map>

namespace viscera {
namespace {

/// Vertices at integer coordinates of the box's grid, each made once.
class BoxVertices {
 public:
  BoxVertices(const Vector3d& min_m, const Vector3d& size_m, const Vector3i& squares)
      : min_m_(min_m), size_m_(size_m), squares_(squares) {}

  uint32_t at(const Vector3i& corner, TriangleMesh& mesh) {
    const auto next = static_cast<uint32_t>(mesh.positions_m.size());
    const auto [found, is_new] = known_.try_emplace({corner.x(), corner.y(), corner.z()}, next);
    if (is_new) {
      const Vector3d fraction = corner.cast<double>().cwiseQuotient(squares_.cast<double>());
      mesh.positions_m.push_back((min_m_ + size_m_.cwiseProduct(fraction)).cast<float>());
    }
    return found->second;
  }

 private:
  Vector3d min_m_, size_m_;
  Vector3i squares_;
  std::map<std::array<int, 3>, uint32_t> known_;
};

}  // namespace

TriangleMesh boxSurface(const Vector3d& min_m, const Vector3d& size_m, const Vector3i& squares) {
  TriangleMesh mesh;
  mesh.part_names = {"box"};
  BoxVertices vertices(min_m, size_m, squares);
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool far_side = side % 2 == 1;
    for (int i = 0; i < squares[u]; ++i) {
      for (int j = 0; j < squares[v]; ++j) {
        const auto corner = [&](int du, int dv) {
          Vector3i at;
          at[axis] = far_side ? squares[axis] : 0;
          at[u] = i + du;
          at[v] = j + dv;
          return vertices.at(at, mesh);
        };
        const uint32_t a = corner(0, 0), b = corner(far_side ? 1 : 0, far_side ? 0 : 1), c = corner(1, 1),
                       d = corner(far_side ? 0 : 1, far_side ? 1 : 0);
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace viscera
