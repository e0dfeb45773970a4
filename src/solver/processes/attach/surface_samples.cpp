// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/attach/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace viscera {

namespace {

constexpr double kPiece = 0.25;    // of a cube's edge: pieces into which triangles are divided
constexpr double kOffSide = 1e-4;  // of a cube's edge: surfaces between two cubes belong to one of them
constexpr int kMostPieces = 512;   // along an edge of a triangle

/// Cube and main direction.
using Key = std::array<int, 4>;
using Samples = std::map<Key, SurfaceSample>;
using Corners = std::array<Vector3d, 3>;

int facing(const Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(2 * axis) + (normal[axis] < 0 ? 1 : 0);
}

void add(const Corners& corners, double edge_m, const Vector3d& origin_m, Samples& samples) {
  const auto& [a, b, c] = corners;
  const Vector3d area = 0.5 * (b - a).cross(c - a);
  if (area.isZero(0)) return;
  const double longest_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int n = std::clamp(static_cast<int>(std::ceil(longest_m / (kPiece * edge_m))), 1, kMostPieces);
  const Vector3d u = (b - a) / n, v = (c - a) / n, normal = area.normalized();
  const double piece_m2 = area.norm() / (n * n);
  const int side = facing(normal);
  const auto put = [&](double i, double j) {
    const Vector3d at = a + i * u + j * v;
    const Vector3d cube = ((at - origin_m) / edge_m).array() + kOffSide;
    SurfaceSample& sample = samples[{static_cast<int>(std::floor(cube.z())), static_cast<int>(std::floor(cube.y())),
                                     static_cast<int>(std::floor(cube.x())), side}];
    sample.at_m += piece_m2 * at;
    sample.normal += piece_m2 * normal;
    sample.area_m2 += piece_m2;
  };
  constexpr double kThird = 1.0 / 3;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i + j < n; ++i) {
      put(i + kThird, j + kThird);
      if (i + j + 1 < n) put(i + 2 * kThird, j + 2 * kThird);
    }
  }
}

}  // namespace

std::vector<SurfaceSample> samplesOf(const TriangleMesh& mesh, double edge_m, const Vector3d& origin_m,
                                     const std::function<bool(const Vector3d&, double)>& wanted) {
  Samples samples;
  for (const std::array<uint32_t, 3>& triangle : mesh.triangles) {
    Corners corners;
    for (size_t c = 0; c < 3; ++c) corners[c] = mesh.positions_m[triangle[c]].cast<double>();
    const Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    double radius_m = 0;
    for (const Vector3d& corner : corners) radius_m = std::max(radius_m, (corner - middle).norm());
    if (wanted(middle, radius_m)) add(corners, edge_m, origin_m, samples);
  }
  std::vector<SurfaceSample> out;
  out.reserve(samples.size());
  for (auto& [key, sample] : samples) {
    sample.at_m /= sample.area_m2;
    sample.normal.normalize();
    out.push_back(sample);
  }
  return out;
}

}  // namespace viscera
