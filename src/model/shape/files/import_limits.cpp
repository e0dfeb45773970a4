// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/import_limits.h"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include "math/number_text.h"
#include "model/shape/files/ply_reader.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kBytesPerMb = 1e6;

std::string extensionOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

void requireAtMost(double found, double most, const std::string& what, const char* key) {
  if (found <= most) return;
  TextOut out;
  out.precision(10);
  out << what << ": " << found << "; accepted: at most " << most << ". Raise it with bodies[].import_limits." << key;
  throw MeshError(out.str());
}

void requireFileSize(const std::string& path, const ImportLimits& limits) {
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(path, error));
  if (!error) requireAtMost(bytes / kBytesPerMb, limits.max_file_mb, "size of the file in MB", "max_file_mb");
}

void requireKnownFormat(const std::string& path, const ImportLimits& limits) {
  constexpr const char* kKnown[] = {".obj", ".stl", ".gltf", ".glb"};
  if (limits.other_formats || isPly(path)) return;
  const std::string extension = extensionOf(path);
  if (std::find(std::begin(kKnown), std::end(kKnown), extension) != std::end(kKnown)) return;
  const std::string found = extension == ".ply" ? "it does not begin with 'ply'" : "found '" + extension + "'";
  throw MeshError("has an unknown extension: " + found +
                  "; accepted: OBJ, STL, PLY, glTF, GLB or Gmsh (.msh). Set bodies[].import_limits.other_formats to "
                  "try other formats");
}

void requireScene(const aiScene& scene, const ImportLimits& limits) {
  double instances = 0, triangles = 0;
  std::vector<const aiNode*> left = {scene.mRootNode};
  while (!left.empty()) {
    const aiNode& node = *left.back();
    left.pop_back();
    ++instances;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) triangles += scene.mMeshes[node.mMeshes[i]]->mNumFaces;
    left.insert(left.end(), node.mChildren, node.mChildren + node.mNumChildren);
  }
  requireAtMost(instances, limits.max_instances, "instances of nodes", "max_instances");
  requireAtMost(triangles, limits.max_triangles, "triangles", "max_triangles");
}

}  // namespace viscera
