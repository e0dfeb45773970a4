// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Looks for triangles of a glTF or GLB file that refer to vertices which do not exist. assimp (5.2) leaves these
/// triangles out without a word. Reads the file's numbers once more: only worth it where triangles are missing.
/// Indices that are packed (Draco) or sparse are not looked at.
/// @throws MeshError  there is one: names mesh, primitive and index
void requireGltfIndices(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
