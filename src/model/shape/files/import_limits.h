// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/scene.h"

struct aiScene;

namespace viscera {

// Checks of a file against a scene's ImportLimits. Errors give the number found, the range, and the key that raises it;
// the caller names the file.

/// Checks a number. @throws MeshError  more than `most`
void requireAtMost(double found, double most, const std::string& what, const char* key);

/// Checks the size of a file. @throws MeshError  the file is larger than accepted
void requireFileSize(const std::string& path, const ImportLimits& limits);

/// Checks that the format is known to be read within limits, or that the scene accepts others.
/// @throws MeshError  neither
void requireKnownFormat(const std::string& path, const ImportLimits& limits);

/// Checks the scene that was read. @throws MeshError  it has more nodes or triangles than accepted
void requireScene(const aiScene& scene, const ImportLimits& limits);

}  // namespace viscera
