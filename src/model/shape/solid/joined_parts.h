// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_shell.h"

namespace viscera {

/// One surface of a mesh: a part, or several with open borders that meet, such as a surface that was split by material.
struct ClosedSurface {
  Shell shell;
  std::vector<uint32_t> triangles;  ///< triangles of the mesh in its order: the shell's own
  uint16_t part = 0;                ///< part with the largest area
  bool is_joined = false;           ///< made of several parts
};

/// Closes the surfaces of a mesh. Parts with open borders that meet in every coordinate are closed together, unless
/// together they are more hole than wall: then each is closed alone. Surfaces without triangles are left out.
std::vector<ClosedSurface> closeSurfaces(const TriangleMesh& mesh);

/// Returns the bounding box of the filled region, without open sheets and without pieces that are crumbs. For a mesh
/// that encloses nothing: the box of the mesh.
Eigen::AlignedBox3d filledBounds(const TriangleMesh& mesh);

/// Returns the area of each part [m2].
std::vector<double> partAreas(const TriangleMesh& mesh);

}  // namespace viscera
