// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Returns the name for a URI of glTF: "%20" is a blank in it.
std::string unescaped(const std::string& uri);

/// Collector of the appearance of the parts of a mesh file: materials, their images, texture coordinates. It leaves out
/// what it cannot use, with a note: nothing is drawn black because of a missing image.
class MeshAppearance {
 public:
  /// @param path  path of the mesh file: images are next to it   @param scene  must outlive this; null: nothing is
  /// collected
  MeshAppearance(std::string path, const aiScene* scene, const ImportLimits& limits)
      : path_(std::move(path)), scene_(scene), limits_(limits) {}

  /// Adds the next part of the mesh. @param name  of the part, for notes
  void addPart(const aiMesh& source, const std::string& name);
  /// Adds the next triangle of that part. @param corners_m  [3] in the frame of the imported mesh
  /// @param face  [3] its vertices in `source`, in the order of the corners
  void addTriangle(const aiMesh& source, const std::array<Eigen::Vector3d, 3>& corners_m,
                   const std::array<unsigned, 3>& face);
  void dropPart() { detail_.part_materials.pop_back(); }  ///< drops a part without triangles
  /// Gives the mesh what was collected, if anything.
  void giveTo(TriangleMesh& mesh);
  const std::vector<std::string>& notes() const { return notes_; }  ///< one line each

 private:
  struct Named {
    SurfaceMaterial material;
    unsigned channel = 0;  ///< channel of texture coordinates, for all of its images
    std::string name;
  };
  const Named& material(unsigned index);
  MaterialTexture texture(const aiMaterial& source, aiTextureType type, const char* key, Named& of);
  int image(const std::string& name, const std::string& key);
  TextureImage load(const std::string& name) const;

  std::string path_;
  const aiScene* scene_;
  ImportLimits limits_;
  SurfaceDetail detail_;
  std::vector<uint32_t> chart_of_triangle_;
  std::map<unsigned, uint32_t> known_materials_;  ///< from a material of the file to an index into detail_.materials
  std::vector<Named> named_;                      ///< [detail_.materials]
  std::map<std::string, int> known_images_;
  bool has_coordinates_ = false;  ///< the part has coordinates, and needs them
  bool said_no_coordinates_ = false;
  uint32_t material_ = kNoChart;  ///< material of the part
  std::vector<std::string> notes_;
};

}  // namespace viscera
