// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace viscera {

/// Triangles of a file that one of our own readers has read.
struct ReadPart {
  std::string name;  ///< empty: no name
  std::vector<aiVector3D> vertices;
  std::vector<std::array<unsigned, 3>> triangles;
};

/// Returns a scene with a single node that has the parts as meshes.
std::unique_ptr<aiScene> sceneOf(const std::vector<ReadPart>& parts);

}  // namespace viscera
