// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/solid.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// How a bake went, for a person.
struct BakeReport {
  int side_px = 0;             ///< of the square that all triangles' texels are in
  double uncovered_share = 0;  ///< of the texels: where the detailed mesh is not near
  /// Between the shading normals of the skin and those of the detailed mesh, at places all over the skin [degrees]:
  /// half of the angles, and 95 in 100, are smaller; and the median without a normal map.
  double median_deg = 0, percentile95_deg = 0, bare_median_deg = 0;
  bool from_cache = false;
  std::string text() const;  ///< one line
};

/// What a detailed mesh looks like, put onto a coarser skin of the same shape (VR05 2.6, 3): normals for a normal map,
/// and its colours where it has textures or, if asked for, where its materials have colours.
struct BakeInput {
  const TriangleMesh& skin;      ///< [m, tissue frame] with vertex normals as vertexNormals() has them
  const TriangleMesh& detailed;  ///< the same frame
  bool with_colors = false;
  int largest_px = 2048;  ///< side of the square of texels, at most
};

/// The skin with charts and a detail of its own: every triangle has texels of its own, half of a square that it shares
/// with another one near it. What was baked once is found in the user's cache, by the contents of both meshes.
/// @throws MeshError  the skin has more triangles than such squares fit
TriangleMesh bakeDetail(const BakeInput& input, BakeReport* report = nullptr, const Progress& progress = {});

/// Places of the cache: as many as there are bakes with different input. Empty: no cache.
std::string detailCacheFolder();

}  // namespace viscera
