// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Properties of a glTF file that libraries handle wrongly.
struct GltfFacts {
  bool is_draco = false;      ///< it requires KHR_draco_mesh_compression
  bool is_quantised = false;  ///< some attribute that is usually real has integers
  double triangles = 0;       ///< number of triangles that its meshes list, each mesh once
};

/// Text of a glTF or GLB file.
struct GltfText {
  std::string json;
  std::string chunks;  ///< of GLB: the chunks after its JSON, with headers
  bool is_glb = false;
};

/// Splits the bytes of a glTF or GLB file. @throws MeshError  a chunk of a GLB file is missing
GltfText splitGltf(std::string bytes);

/// Returns whether a file begins like glTF's JSON or GLB, whatever its name.
bool looksLikeGltf(const std::string& path);

/// Checks the tree of a glTF or GLB file before a library reads it, which would recurse into it and copy shared nodes.
/// Reads the text once, without recursion, and keeps only numbers of it.
/// @throws MeshError  it is cut short, no JSON or another version than 2; nodes form a cycle; it exceeds a limit:
/// number found, range and key; or it requires an extension that is not read. The caller names the file.
GltfFacts requireGltfWithin(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
