// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

bool isMsh(const std::string& path);

/// Reads the solid of a Gmsh file: MSH 1, 2.0 to 2.2, 4.0 and 4.1, ASCII and binary; tetrahedra, hexahedra, prisms and
/// pyramids of first and second order. Each physical group of volumes becomes a closed part that faces outward. Its
/// surface consists of the faces that only one of its elements has. Groups that touch have the same triangles, each
/// facing outward of its own. Faces of second order are divided at their nodes.
/// @param unit_scale_m  metres per file unit, > 0   @param note  gets a line on what was read and skipped
/// @throws MeshError  with line or byte, without the file's name: no element of three dimensions; a number that is
///                    invalid, not finite or missing; counts that do not match; a node that is missing or listed
///                    twice; a flat element; elements that overlap at a face, or of third order; more triangles than
///                    accepted
TriangleMesh readMsh(const std::string& path, double unit_scale_m, const ImportLimits& limits, std::string& note);

}  // namespace viscera
