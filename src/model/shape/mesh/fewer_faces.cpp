// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/mesh/fewer_faces.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr size_t kLeastFaces = 64;  // per part: fewer do not represent a shape
constexpr float kMostError = 0.1F;  // share of the mesh's extent: the number of faces decides, not this

}  // namespace

TriangleMesh withFewerFaces(const TriangleMesh& mesh, size_t faces) {
  std::vector<std::vector<unsigned>> of_part(mesh.part_names.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    of_part[mesh.parts[t]].insert(of_part[mesh.parts[t]].end(), corners.begin(), corners.end());
  }
  const double share = static_cast<double>(faces) / static_cast<double>(mesh.triangles.size());
  TriangleMesh out;
  out.part_names = mesh.part_names;
  out.detail = mesh.detail;
  std::vector<uint32_t> moved(mesh.positions_m.size(), UINT32_MAX);
  for (size_t part = 0; part < of_part.size(); ++part) {
    const std::vector<unsigned>& indices = of_part[part];
    if (indices.empty()) continue;
    const size_t has = indices.size() / 3, least = std::min(kLeastFaces, has);  // meshopt_simplify aborts on more
    const size_t wanted = std::max(static_cast<size_t>(share * static_cast<double>(has)), least);
    std::vector<unsigned> fewer(indices.size());
    // Borders are locked: other parts may share them.
    fewer.resize(meshopt_simplify(fewer.data(), indices.data(), indices.size(), mesh.positions_m[0].data(),
                                  mesh.positions_m.size(), sizeof(Vector3f), 3 * wanted, kMostError,
                                  meshopt_SimplifyLockBorder, nullptr));
    for (size_t i = 0; i < fewer.size(); ++i) {
      uint32_t& vertex = moved[fewer[i]];
      if (vertex == UINT32_MAX) {
        vertex = static_cast<uint32_t>(out.positions_m.size());
        out.positions_m.push_back(mesh.positions_m[fewer[i]]);
      }
      if (i % 3 == 0) out.triangles.emplace_back();
      out.triangles.back()[i % 3] = vertex;
    }
    out.parts.resize(out.triangles.size(), static_cast<uint16_t>(part));
  }
  return out;
}

}  // namespace viscera
