// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Checks that no triangle of a glTF or GLB file refers to a missing vertex. assimp (5.2) drops such triangles
/// silently. It reads the file's numbers again, so call it only where triangles are missing. Packed (Draco) and sparse
/// indices are not checked.
/// @throws MeshError  there is one: names mesh, primitive and index
void requireGltfIndices(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
