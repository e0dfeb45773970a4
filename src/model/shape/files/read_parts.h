// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace viscera {

/// Triangles of a file that a reader of ours has read.
struct ReadPart {
  std::string name;  ///< empty: it has none
  std::vector<aiVector3D> vertices;
  std::vector<std::array<unsigned, 3>> triangles;
};

/// Hands parts over as meshes of the single node of a scene.
std::unique_ptr<aiScene> sceneOf(const std::vector<ReadPart>& parts);

}  // namespace viscera
