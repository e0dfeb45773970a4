// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/solid.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Statistics of a bake, for a person.
struct BakeReport {
  int side_px = 0;             ///< side of the square with the texels of all triangles [px]
  double uncovered_share = 0;  ///< share of the texels without the detailed mesh nearby
  /// Angles between the shading normals of the surface and those of the detailed mesh, at points all over the surface
  /// [degrees]: median and 95th percentile, and the median without a normal map.
  double median_deg = 0, percentile95_deg = 0, bare_median_deg = 0;
  bool from_cache = false;
  std::string text() const;  ///< one line
};

/// Appearance of a detailed mesh, baked onto a coarser surface of the same shape (VR05 2.6, 3). It gives normals for a
/// normal map, and colours where the mesh has textures or, if requested, where its materials have colours.
struct BakeInput {
  const TriangleMesh& skin;      ///< surface [m, tissue frame], with vertex normals of vertexNormals()
  const TriangleMesh& detailed;  ///< detailed mesh, same frame
  bool with_colors = false;
  int largest_px = 2048;  ///< largest side of the square of texels [px]
};

/// Returns the surface with charts and a detail of its own: every triangle has its own texels, half of a square that it
/// shares with a nearby one. Earlier bakes are read from the user's cache, by the contents of both meshes.
/// @throws MeshError  the surface has more triangles than the square has room for
TriangleMesh bakeDetail(const BakeInput& input, BakeReport* report = nullptr, const Progress& progress = {});

/// Returns the folder of the cache, with one file per bake of different input. Empty: no cache.
std::string detailCacheFolder();

}  // namespace viscera
