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

/// Returns a name of which glTF has a URI: "%20" is a blank in it.
std::string unescaped(const std::string& uri);

/// Gathers what a mesh file says of the look of its parts: materials, their pictures, texture coordinates. What it
/// cannot use it leaves out, and says so: nothing is drawn black for want of a picture.
class MeshLook {
 public:
  /// @param path  of the mesh file: pictures lie beside it   @param scene  must outlive this; null: nothing is gathered
  MeshLook(std::string path, const aiScene* scene, const ImportLimits& limits)
      : path_(std::move(path)), scene_(scene), limits_(limits) {}

  /// The next part of the mesh. @param name  of the part, for notes
  void addPart(const aiMesh& source, const std::string& name);
  /// The next triangle of that part. @param corners_m  [3] in the frame of the mesh as it is imported
  /// @param face  [3] its vertices in `source`, in the order of the corners
  void addTriangle(const aiMesh& source, const std::array<Eigen::Vector3d, 3>& corners_m,
                   const std::array<unsigned, 3>& face);
  void dropPart() { detail_.part_materials.pop_back(); }  ///< that has no triangle
  /// Gives the mesh what was gathered, if anything.
  void giveTo(TriangleMesh& mesh);
  const std::vector<std::string>& notes() const { return notes_; }  ///< one line each

 private:
  struct Named {
    SurfaceMaterial material;
    unsigned channel = 0;  ///< of texture coordinates, for all of its pictures
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
  std::map<unsigned, uint32_t> known_materials_;  ///< of the file: index into detail_.materials
  std::vector<Named> named_;                      ///< [detail_.materials]
  std::map<std::string, int> known_images_;
  bool has_coordinates_ = false;  ///< the part has them, and a use for them
  bool said_no_coordinates_ = false;
  uint32_t material_ = kNoChart;  ///< of the part
  std::vector<std::string> notes_;
};

}  // namespace viscera
