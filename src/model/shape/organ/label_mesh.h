// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// The labels that a body is made of, each a closed part of one mesh, where the scan has them [m]. Labels that touch
/// have the same triangles, each facing outward of its own.
/// @param folder  where relative files are looked up   @param notes  gets what reading had to decide
/// @throws SceneError  naming the body, the file and what is accepted
TriangleMesh labelMesh(const BodyConfig& config, const std::string& folder, std::vector<std::string>& notes);

/// The outer border of parts that touch: without triangles that two parts have, and vertices that are then unused.
TriangleMesh withoutSharedBorders(const TriangleMesh& mesh);

}  // namespace viscera
