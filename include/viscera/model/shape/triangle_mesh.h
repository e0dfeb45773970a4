// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/surface_detail.h"

namespace VISCERA_PUBLIC viscera {

/// Triangles with shared vertices and named parts. Positions are in metres, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vector3f> positions_m;               ///< [vertices]
  std::vector<std::array<uint32_t, 3>> triangles;  ///< [triangles] vertex indices
  std::vector<uint16_t> parts;                     ///< [triangles] index into part_names
  std::vector<std::string> part_names;
  std::vector<uint32_t> charts;  ///< [triangles] index into detail->charts, or kNoChart; empty: no triangle has one
  std::shared_ptr<const SurfaceDetail> detail;  ///< null: no detail beyond the triangles
};

/// Returns the signed volume [m3] by the divergence theorem; exact for closed, outward-oriented meshes.
double signedVolume(const TriangleMesh& mesh);

/// Returns unit vertex normals, weighted by face area; (0, 0, 1) where a vertex has no area around it.
std::vector<Vector3f> vertexNormals(const TriangleMesh& mesh);

/// Splits edges longer than `longest_edge_m` at their midpoints until none is left, keeping the mesh conforming.
TriangleMesh refine(const TriangleMesh& mesh, double longest_edge_m);

}  // namespace viscera
