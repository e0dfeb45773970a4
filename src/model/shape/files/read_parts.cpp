// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/read_parts.h"

#include <algorithm>
#include <numeric>

namespace viscera {
namespace {

aiMesh* meshOf(const ReadPart& part) {
  auto out = std::make_unique<aiMesh>();
  out->mName.Set(part.name);
  out->mNumVertices = static_cast<unsigned>(part.vertices.size());
  out->mVertices = new aiVector3D[part.vertices.size()];
  std::copy(part.vertices.begin(), part.vertices.end(), out->mVertices);
  out->mNumFaces = static_cast<unsigned>(part.triangles.size());
  out->mFaces = new aiFace[part.triangles.size()];
  for (size_t t = 0; t < part.triangles.size(); ++t) {
    out->mFaces[t].mNumIndices = 3;
    out->mFaces[t].mIndices = new unsigned[3];
    std::copy(part.triangles[t].begin(), part.triangles[t].end(), out->mFaces[t].mIndices);
  }
  return out.release();
}

}  // namespace

std::unique_ptr<aiScene> sceneOf(const std::vector<ReadPart>& parts) {
  auto scene = std::make_unique<aiScene>();
  scene->mMeshes = new aiMesh*[parts.size()]();
  scene->mNumMeshes = static_cast<unsigned>(parts.size());
  for (size_t p = 0; p < parts.size(); ++p) scene->mMeshes[p] = meshOf(parts[p]);
  scene->mRootNode = new aiNode;
  scene->mRootNode->mNumMeshes = scene->mNumMeshes;
  scene->mRootNode->mMeshes = new unsigned[parts.size()];
  std::iota(scene->mRootNode->mMeshes, scene->mRootNode->mMeshes + parts.size(), 0U);
  return scene;
}

}  // namespace viscera
