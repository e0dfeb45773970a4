// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_shell.h"

namespace viscera {

/// One surface of a mesh: a part, or several whose open borders meet, such as a surface that was split by material.
struct ClosedSurface {
  Shell shell;
  std::vector<uint32_t> triangles;  ///< of the mesh, in its order: the shell's own
  uint16_t part = 0;                ///< the one with the largest area
  bool is_joined = false;           ///< of several parts
};

/// Closes the surfaces of a mesh. Parts with open borders that meet in every coordinate are closed together, unless
/// they are more hole than wall together: then each is closed alone. Those without triangles are left out.
std::vector<ClosedSurface> closeSurfaces(const TriangleMesh& mesh);

/// Returns the box of what is filled: without open sheets, and without pieces so small that they are crumbs.
/// Of a mesh that encloses nothing: its own box.
Eigen::AlignedBox3d filledBounds(const TriangleMesh& mesh);

/// Returns the area of each part [m2].
std::vector<double> partAreas(const TriangleMesh& mesh);

}  // namespace viscera
