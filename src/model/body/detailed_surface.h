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

/// Detail for a surface.
struct DetailWanted {
  const BodyConfig& config;
  const std::string& folder;  ///< folder for a relative detail_mesh
  Pose file_pose;             ///< Tissue::file_pose
  double longest_edge_m;      ///< longest edge of the surface mesh [m]: the lattice's spacing
  PlacedPaint paint;          ///< Tissue::paint(), used where there is no other detail
};

/// Returns the surface with fewer faces, refined to the lattice's spacing. The shape and colour that it or a finer mesh
/// had are baked onto it (docs/surface.md).
/// @param notes  gets a line on what was done
/// @throws MeshError  a detail mesh that cannot be read, or that is elsewhere; too many faces for detail_px
/// @throws LatticeError  as requireSkinSize()
TriangleMesh detailedSurface(TriangleMesh surface, const DetailWanted& wanted, std::vector<std::string>& notes,
                             const Progress& progress = {});

/// Gives the parts of a surface mesh the colours of the scene; a texture of a file still covers them.
TriangleMesh withPartColors(TriangleMesh mesh, const std::vector<PartConfig>& parts);

}  // namespace viscera
