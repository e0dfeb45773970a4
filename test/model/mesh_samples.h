// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "support/source_folder.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::test {

constexpr double kPi = 3.14159265358979323846;

inline TriangleMesh boxMesh(const Vector3f& low, const Vector3f& high) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.positions_m.push_back({c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z()});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.parts.assign(12, 0);
  mesh.part_names = {"box"};
  return mesh;
}

/// Returns a sphere of `rings` x 2 `rings` patches with triangles around two poles, without its top `open_rings` rings.
inline TriangleMesh sphereMesh(const Vector3f& center, float radius, int rings, int open_rings = 0) {
  TriangleMesh mesh;
  const int sectors = 2 * rings;
  const auto at = [&](int ring, int sector) -> uint32_t {
    if (ring == 0) return 0;
    if (ring == rings) return 1;
    return static_cast<uint32_t>(2 + (ring - 1) * sectors + sector % sectors);
  };
  const auto point = [&](int ring, int sector) -> Vector3f {
    const double t = kPi * ring / rings, p = 2 * kPi * sector / sectors;
    const Vector3d direction(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
    return center + radius * direction.cast<float>();
  };
  mesh.positions_m = {point(0, 0), point(rings, 0)};
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) mesh.positions_m.push_back(point(r, s));
  }
  for (int r = open_rings; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      if (r > 0) mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r, s + 1)});
      if (r < rings - 1) mesh.triangles.push_back({at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)});
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  mesh.part_names = {"sphere"};
  return mesh;
}

inline double sphereVolume(double radius) {
  return 4.0 / 3.0 * kPi * radius * radius * radius;
}

inline TriangleMesh turnedInsideOut(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Returns both meshes in one; the second keeps its parts, or joins the first part.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, bool same_part) {
  const auto vertices = static_cast<uint32_t>(a.positions_m.size());
  const auto parts = static_cast<uint16_t>(a.part_names.size());
  a.positions_m.insert(a.positions_m.end(), b.positions_m.begin(), b.positions_m.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
  for (const uint16_t p : b.parts) a.parts.push_back(same_part ? 0 : p + parts);
  if (!same_part) a.part_names.insert(a.part_names.end(), b.part_names.begin(), b.part_names.end());
  return a;
}

/// Returns the number of edges without opposite triangles in pairs: 0 for a closed, consistently oriented mesh.
inline size_t openEdges(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> net;
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = t[c], b = t[(c + 1) % 3];
      net[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  size_t open = 0;
  for (const auto& [edge, balance] : net) open += balance != 0;
  return open;
}

inline double longestEdge(const TriangleMesh& mesh) {
  double longest = 0;
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const Vector3d edge = mesh.positions_m[t[c]].cast<double>() - mesh.positions_m[t[(c + 1) % 3]].cast<double>();
      longest = std::max(longest, edge.norm());
    }
  }
  return longest;
}

/// Returns a new path for a file of the running test.
inline std::string temporaryPath(const std::string& name) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "viscera_model" /
                                       (std::string(test->test_suite_name()) + test->name());
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

/// Returns the path of real data, next to the repository or in VISCERA_TEST_DATA; empty where it is missing.
inline std::string realData(const std::string& name) {
  const char* given = std::getenv("VISCERA_TEST_DATA");
  const std::filesystem::path folder = given ? given : sourceFolder() + "/../shared/data";
  const std::filesystem::path path = folder / name;
  return std::filesystem::exists(path) ? path.string() : "";
}

}  // namespace viscera::test
