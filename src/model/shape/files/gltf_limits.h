// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// What a library gets wrong of a glTF file.
struct GltfFacts {
  bool is_draco = false;      ///< it requires KHR_draco_mesh_compression
  bool is_quantised = false;  ///< some attribute that is usually real has whole numbers
  double triangles = 0;       ///< that its meshes list, each mesh once
};

/// The text of a glTF or GLB file.
struct GltfText {
  std::string json;
  std::string chunks;  ///< of GLB: what follows the chunk of its JSON, headers included
  bool is_glb = false;
};

/// Splits the bytes of a glTF or GLB file. @throws MeshError  a chunk of a GLB file is not there
GltfText splitGltf(std::string bytes);

/// Does a file begin as glTF's JSON or as GLB does, whatever its name?
bool looksLikeGltf(const std::string& path);

/// Looks at a glTF or GLB file's own tree before a library does, which would recurse into it and unroll what its nodes
/// share. Reads the text once, without recursion, and keeps but numbers of it.
/// @throws MeshError  it is cut short, no JSON or another version than 2; nodes are nested in a circle; or there is
/// more than the limits accept: number found, range and key; or it requires what is not read. The caller names the
/// file.
GltfFacts requireGltfWithin(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
