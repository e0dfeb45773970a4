// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/mesh/plain_meshes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace viscera {
namespace {

/// Twelve corners of an icosahedron of radius 1 and its twenty faces, counter-clockwise seen from outside.
struct Icosahedron {
  std::array<Vector3d, 12> corners;
  std::array<std::array<uint32_t, 3>, 20> faces;
};

Icosahedron icosahedron() {
  Icosahedron out;
  const double pi = std::acos(-1.0), z = 1 / std::sqrt(5.0), r = 2 / std::sqrt(5.0);
  out.corners[0] = Vector3d::UnitZ();
  out.corners[11] = -Vector3d::UnitZ();
  for (uint32_t i = 0; i < 5; ++i) {
    const double upper = 2 * pi / 5 * i, lower = upper + pi / 5;
    out.corners[1 + i] = {r * std::cos(upper), r * std::sin(upper), z};
    out.corners[6 + i] = {r * std::cos(lower), r * std::sin(lower), -z};
    const uint32_t a = 1 + i, b = 1 + (i + 1) % 5, c = 6 + i, d = 6 + (i + 1) % 5;
    out.faces[4 * i] = {0, a, b};
    out.faces[4 * i + 1] = {a, c, b};
    out.faces[4 * i + 2] = {b, c, d};
    out.faces[4 * i + 3] = {c, 11, d};
  }
  return out;
}

/// Points of the icosahedron's faces, each made once: a point is identified by its integer weights of the corners.
class BallPoints {
 public:
  BallPoints(const Icosahedron& shape, double radius_m, TriangleMesh& mesh)
      : shape_(shape), radius_m_(radius_m), mesh_(mesh) {}

  uint32_t at(const std::array<uint32_t, 3>& face, const std::array<int, 3>& weights) {
    std::map<uint32_t, int> key;
    for (size_t c = 0; c < 3; ++c) {
      if (weights[c] > 0) key[face[c]] = weights[c];
    }
    const auto [found, is_new] = known_.try_emplace(key, static_cast<uint32_t>(mesh_.positions_m.size()));
    if (is_new) {
      Vector3d sum = Vector3d::Zero();
      for (const auto& [corner, weight] : key) sum += weight * shape_.corners[corner];
      mesh_.positions_m.push_back((radius_m_ * sum.normalized()).cast<float>());
    }
    return found->second;
  }

 private:
  const Icosahedron& shape_;
  double radius_m_;
  TriangleMesh& mesh_;
  std::map<std::map<uint32_t, int>, uint32_t> known_;
};

}  // namespace

TriangleMesh sheetMesh(int rows, int columns, double spacing_m, SheetSides sides) {
  assert(rows >= 2 && columns >= 2 && spacing_m > 0);
  TriangleMesh mesh;
  mesh.part_names = {"sheet"};
  const double height_m = std::sqrt(0.75) * spacing_m;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool at_side = column == 0 || column == columns - 1;
      const double shift = sides == SheetSides::kStraight && at_side ? 0 : 0.5 * (row % 2) - 0.25;
      const double x = column - 0.5 * (columns - 1) + shift, y = row - 0.5 * (rows - 1);
      mesh.positions_m.push_back(Vector3d(x * spacing_m, y * height_m, 0).cast<float>());
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<uint32_t>(row * columns + column), b = a + 1;
      const uint32_t c = a + static_cast<uint32_t>(columns), d = c + 1;
      // The two triangles share the short diagonal: it leans with the shift of the upper row.
      if (row % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

SheetGrid sheetGrid(double size_x_m, double size_y_m, double spacing_m) {
  const auto along = [](double edges) { return std::max(2, 1 + static_cast<int>(std::lround(edges))); };
  return {along(size_y_m / (std::sqrt(0.75) * spacing_m)), along(size_x_m / spacing_m)};
}

TriangleMesh ballMesh(double radius_m, double spacing_m) {
  // The number of edges per edge of the icosahedron is such that 20 n^2 equilateral triangles cover the sphere.
  const double pi = std::acos(-1.0), edge = std::sqrt(16 * pi / (20 * std::sqrt(3.0)));
  const int n = std::max(1, static_cast<int>(std::lround(edge * radius_m / spacing_m)));
  TriangleMesh mesh;
  mesh.part_names = {"ball"};
  const Icosahedron shape = icosahedron();
  BallPoints points(shape, radius_m, mesh);
  for (const auto& face : shape.faces) {
    const auto at = [&](int i, int j) { return points.at(face, {n - i - j, i, j}); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace viscera
