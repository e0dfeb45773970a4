// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Returns the labels of a body as closed parts of one mesh, at their positions in the scan [m]. Labels that touch have
/// the same triangles, each facing outward of its own.
/// @param folder  folder for relative files   @param notes  gets decisions made while reading
/// @throws SceneError  names the body, the file and what is accepted
TriangleMesh labelMesh(const BodyConfig& config, const std::string& folder, std::vector<std::string>& notes);

/// Returns the outer border of parts that touch: without triangles that two parts have, and vertices that are then
/// unused.
TriangleMesh withoutSharedBorders(const TriangleMesh& mesh);

}  // namespace viscera
