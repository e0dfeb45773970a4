// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "model/shape/solid/tetrahedra_mesh.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// What was read, and what was passed over.
struct MshReport {
  std::string version;
  size_t tetrahedra = 0;
  size_t other_elements = 0;  ///< points, lines, triangles
  size_t turned = 0;          ///< tetrahedra of negative volume, whose last two corners changed places
  size_t unused_nodes = 0;    ///< nodes of no tetrahedron, left out
  std::string text() const;   ///< one line for a person
};

/// Reads the tetrahedra of a Gmsh file, MSH 2.2 or 4.1, ASCII. Points, lines and triangles are passed over, physical
/// groups ignored.
/// @param unit_scale_m  metres per file unit, > 0
/// @throws MeshError  with file and line: missing, binary or of another version; a number that is none, is not finite
/// or
///                    missing; counts that do not match; a node that is not there or stands twice; other elements of
///                    three dimensions, or of higher order; a flat tetrahedron; no tetrahedron at all
TetrahedraMesh readMsh(const std::string& path, double unit_scale_m, MshReport* report = nullptr,
                       const ImportLimits& limits = {});

}  // namespace viscera
