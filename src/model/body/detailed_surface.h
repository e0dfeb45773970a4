// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/detail/detail_paint.h"
#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/solid.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// What a surface is to be detailed with.
struct DetailWanted {
  const BodyConfig& config;
  const std::string& folder;  ///< where a relative detail_mesh is looked up
  Pose file_pose;             ///< Tissue::file_pose
  double longest_edge_m;      ///< of the skin: the lattice's spacing
  PlacedPaint paint;          ///< Tissue::paint(), where there is no other detail
};

/// The surface, with fewer faces and refined as its lattice wants it, and what it or a finer mesh had of shape and
/// colour baked onto it (docs/detail.md).
/// @param notes  gets a line of what was done
/// @throws MeshError  a detail mesh that cannot be read, or that lies elsewhere; too many faces for detail_px
/// @throws LatticeError  as requireSkinSize()
TriangleMesh detailedSurface(TriangleMesh surface, const DetailWanted& wanted, std::vector<std::string>& notes,
                             const Progress& progress = {});

}  // namespace viscera
