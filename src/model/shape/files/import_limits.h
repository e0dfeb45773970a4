// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/scene.h"

struct aiScene;

namespace viscera {

// What a file holds against what a scene accepts of it, ImportLimits. Errors give the number found, the range, and the
// key that raises it; their caller names the file.

/// @throws MeshError  more than `most`
void requireAtMost(double found, double most, const std::string& what, const char* key);

/// @throws MeshError  the file is larger than accepted
void requireFileSize(const std::string& path, const ImportLimits& limits);

/// A format that libraries were seen to read within limits, or a scene that accepts others?
/// @throws MeshError  neither
void requireKnownFormat(const std::string& path, const ImportLimits& limits);

/// @throws MeshError  what was read has more nodes or triangles than accepted
void requireScene(const aiScene& scene, const ImportLimits& limits);

}  // namespace viscera
