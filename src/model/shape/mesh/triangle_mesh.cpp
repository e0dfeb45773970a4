// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/triangle_mesh.h"

#include <algorithm>
#include <cassert>
#include <unordered_map>

namespace viscera {
namespace {

constexpr uint32_t kNoMidpoint = UINT32_MAX;

uint64_t edgeKey(uint32_t a, uint32_t b) {
  return (static_cast<uint64_t>(std::min(a, b)) << 32) | static_cast<uint64_t>(std::max(a, b));
}

/// One pass over all triangles: every edge that is too long gets one midpoint, which the triangles around it share.
class SplitPass {
 public:
  SplitPass(TriangleMesh& mesh, double longest_edge_m) : mesh_(mesh), longest_edge_m_(longest_edge_m) {}

  /// Returns whether any edge was split.
  bool run() {
    std::vector<std::array<uint32_t, 3>> old_triangles;
    std::vector<uint16_t> old_parts;
    std::vector<uint32_t> old_charts;
    old_triangles.swap(mesh_.triangles);
    old_parts.swap(mesh_.parts);
    old_charts.swap(mesh_.charts);
    for (size_t t = 0; t < old_triangles.size(); ++t) {
      split(old_triangles[t], old_parts[t]);
      if (!old_charts.empty()) mesh_.charts.resize(mesh_.triangles.size(), old_charts[t]);
    }
    return !midpoints_.empty();
  }

 private:
  double length(uint32_t a, uint32_t b) const {
    return (mesh_.positions_m[a].cast<double>() - mesh_.positions_m[b].cast<double>()).norm();
  }

  uint32_t midpoint(uint32_t a, uint32_t b) {
    if (!(length(a, b) > longest_edge_m_)) return kNoMidpoint;
    const auto next = static_cast<uint32_t>(mesh_.positions_m.size());
    const auto [found, is_new] = midpoints_.try_emplace(edgeKey(a, b), next);
    if (is_new) {
      const Vector3d middle = 0.5 * (mesh_.positions_m[a].cast<double>() + mesh_.positions_m[b].cast<double>());
      mesh_.positions_m.push_back(middle.cast<float>());
    }
    return found->second;
  }

  void add(uint32_t a, uint32_t b, uint32_t c, uint16_t part) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.parts.push_back(part);
  }

  void split(const std::array<uint32_t, 3>& corners, uint16_t part) {
    std::array<uint32_t, 3> middles;  // of the edges 01, 12, 20
    for (int e = 0; e < 3; ++e) middles[e] = midpoint(corners[e], corners[(e + 1) % 3]);
    const auto marked = 3 - std::count(middles.begin(), middles.end(), kNoMidpoint);
    if (marked == 0) return add(corners[0], corners[1], corners[2], part);
    if (marked == 3) return splitInFour(corners, middles, part);
    // Turn the triangle so that its first edge is marked, and its third is not.
    int first = 0;
    while (middles[first] == kNoMidpoint || middles[(first + 2) % 3] != kNoMidpoint) ++first;
    const uint32_t a = corners[first], b = corners[(first + 1) % 3], c = corners[(first + 2) % 3];
    const uint32_t ab = middles[first], bc = middles[(first + 1) % 3];
    if (marked == 1) {
      add(a, ab, c, part);
      add(ab, b, c, part);
    } else {
      splitInThree(a, b, c, ab, bc, part);
    }
  }

  void splitInThree(uint32_t a, uint32_t b, uint32_t c, uint32_t ab, uint32_t bc, uint16_t part) {
    add(ab, b, bc, part);
    if (length(a, bc) < length(ab, c)) {
      add(a, ab, bc, part);
      add(a, bc, c, part);
    } else {
      add(a, ab, c, part);
      add(ab, bc, c, part);
    }
  }

  void splitInFour(const std::array<uint32_t, 3>& corners, const std::array<uint32_t, 3>& middles, uint16_t part) {
    for (int e = 0; e < 3; ++e) add(corners[e], middles[e], middles[(e + 2) % 3], part);
    add(middles[0], middles[1], middles[2], part);
  }

  TriangleMesh& mesh_;
  double longest_edge_m_;
  std::unordered_map<uint64_t, uint32_t> midpoints_;
};

}  // namespace

double signedVolume(const TriangleMesh& mesh) {
  if (mesh.positions_m.empty()) return 0;
  // Relative to a vertex of the mesh: far from the origin the products of six factors would cancel.
  const Vector3d base = mesh.positions_m[0].cast<double>();
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.positions_m[t[0]].cast<double>() - base;
    const Vector3d b = mesh.positions_m[t[1]].cast<double>() - base;
    const Vector3d c = mesh.positions_m[t[2]].cast<double>() - base;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

std::vector<Vector3f> vertexNormals(const TriangleMesh& mesh) {
  std::vector<Vector3d> sums(mesh.positions_m.size(), Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.positions_m[t[0]].cast<double>();
    const Vector3d b = mesh.positions_m[t[1]].cast<double>();
    const Vector3d c = mesh.positions_m[t[2]].cast<double>();
    const Vector3d doubled_area = (b - a).cross(c - a);
    for (const uint32_t v : t) sums[v] += doubled_area;
  }
  std::vector<Vector3f> normals(sums.size(), Vector3f::UnitZ());
  for (size_t v = 0; v < sums.size(); ++v) {
    const double length = sums[v].norm();
    if (length > 0) normals[v] = (sums[v] / length).cast<float>();
  }
  return normals;
}

TriangleMesh refine(const TriangleMesh& mesh, double longest_edge_m) {
  assert(longest_edge_m > 0);
  TriangleMesh refined = mesh;
  while (SplitPass(refined, longest_edge_m).run()) {
  }
  return refined;
}

}  // namespace viscera
