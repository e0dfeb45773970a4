// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/gltf_indices.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "model/shape/files/gltf_file.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using Json = nlohmann::json;

size_t bytesOfIndex(int component_type) {
  return component_type == 5121 ? 1 : component_type == 5123 ? 2 : component_type == 5125 ? 4 : 0;
}

/// Returns "mesh 2 ('liver'), primitive 0".
std::string primitiveName(const Json& mesh, size_t m, size_t p) {
  const auto name = mesh.find("name");
  const bool is_named = name != mesh.end() && name->is_string();
  return "mesh " + std::to_string(m) + (is_named ? " ('" + name->get<std::string>() + "')" : "") + ", primitive " +
         std::to_string(p);
}

void requireIndices(GltfFile& file, const Json& primitive, const std::string& name) {
  const Json& accessors = file.json().at("accessors");
  const auto accessor = primitive.at("indices").get<size_t>();
  const Json& indices = accessors.at(accessor);
  const size_t bytes = bytesOfIndex(indices.at("componentType"));
  if (bytes == 0 || indices.contains("sparse") || !indices.contains("bufferView")) return;
  const auto vertices = accessors.at(primitive.at("attributes").at("POSITION").get<size_t>()).at("count").get<size_t>();
  const GltfFile::Items items = file.items(accessor, bytes);
  for (size_t i = 0; i < items.count; ++i) {
    uint32_t index = 0;  // glTF has the byte order of this machine
    std::memcpy(&index, items.at(i), bytes);
    if (index < vertices) continue;
    throw MeshError("is corrupt: " + name + ": index " + std::to_string(i) + " is " + std::to_string(index) +
                    ", but there are " + std::to_string(vertices) + " vertices; export it again");
  }
}

}  // namespace

void requireGltfIndices(const std::string& path, const ImportLimits& limits) {
  try {
    GltfFile file(path, limits);
    const Json& meshes = file.json().at("meshes");
    for (size_t m = 0; m < meshes.size(); ++m) {
      const Json& primitives = meshes[m].at("primitives");
      for (size_t p = 0; p < primitives.size(); ++p) {
        const Json& primitive = primitives[p];
        const auto extensions = primitive.find("extensions");
        const bool is_packed = extensions != primitive.end() && extensions->contains("KHR_draco_mesh_compression");
        if (primitive.contains("indices") && primitive.at("attributes").contains("POSITION") && !is_packed)
          requireIndices(file, primitive, primitiveName(meshes[m], m, p));
      }
    }
  } catch (const Json::exception& error) {
    throw MeshError(std::string("is corrupt: ") + error.what());
  }
}

}  // namespace viscera
