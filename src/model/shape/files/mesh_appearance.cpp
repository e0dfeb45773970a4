// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/mesh_appearance.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "math/one_line.h"
#include "math/srgb.h"
#include "model/scene/file_bounds.h"
#include "model/shape/files/image_decoder.h"
#include "model/shape/files/import_limits.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

namespace fs = std::filesystem;

constexpr double kFarthestCoordinate = 1e5;  // periods of an image: beyond it float32 does not resolve one texel

TextureWrap wrapOf(int mode) {
  if (mode == aiTextureMapMode_Mirror) return TextureWrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? TextureWrap::kRepeat : TextureWrap::kClamp;
}

/// Returns an image inside the mesh file, compressed or as texels.
TextureImage embedded(const aiTexture& texture) {
  const auto* const bytes = reinterpret_cast<const uint8_t*>(texture.pcData);
  if (texture.mHeight == 0) return decodeImage(bytes, texture.mWidth);
  TextureImage image;
  image.width_px = static_cast<int>(texture.mWidth);
  image.height_px = static_cast<int>(texture.mHeight);
  for (unsigned row = texture.mHeight; row > 0; --row) {
    for (unsigned x = 0; x < texture.mWidth; ++x) {
      const aiTexel& texel = texture.pcData[size_t{texture.mWidth} * (row - 1) + x];
      image.rgba.insert(image.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
    }
  }
  return image;
}

}  // namespace

std::string unescaped(const std::string& uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                         std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
    out += escaped ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i] == '\\' ? '/' : uri[i];
    if (escaped) i += 2;
  }
  return out;
}

TextureImage MeshAppearance::load(const std::string& name) const {
  if (const aiTexture* within = scene_->GetEmbeddedTexture(name.c_str())) return embedded(*within);
  const fs::path folder = fs::path(path_).parent_path();
  fs::path file = folder / name;
  std::error_code error;
  for (const std::string& each : {name, unescaped(name)}) requireWithinBounds((folder / each).string());
  if (!fs::is_regular_file(file, error)) file = folder / unescaped(name);
  if (!fs::is_regular_file(file, error)) throw MeshError("no such file");
  requireFileSize(file.string(), limits_);
  std::ifstream in(file, std::ios::binary);
  const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  return decodeImage(bytes.data(), bytes.size());
}

/// Loads an image once. @returns index into detail_.images; -1 where it cannot be used, with one note
int MeshAppearance::image(const std::string& name, const std::string& key) {
  const auto known = known_images_.find(name);
  if (known != known_images_.end()) return known->second;
  int index = -1;
  try {
    detail_.images.push_back(load(name));
    index = static_cast<int>(detail_.images.size() - 1);
  } catch (const MeshError& error) {
    notes_.push_back(oneLine(path_ + ": " + key + " '" + name + "' " + error.what() + "; drawn without it"));
  }
  known_images_[name] = index;
  return index;
}

MaterialTexture MeshAppearance::texture(const aiMaterial& source, aiTextureType type, const char* key, Named& of) {
  aiString name;
  MaterialTexture out;
  if (source.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) return out;
  int channel = 0, u = aiTextureMapMode_Wrap, v = aiTextureMapMode_Wrap;
  source.Get(AI_MATKEY_UVWSRC(type, 0), channel);
  source.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), u);
  source.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), v);
  const std::string where = std::string(key) + " of material '" + of.name + "'";
  const bool first = !of.material.hasTexture();
  if (first) of.channel = static_cast<unsigned>(std::max(channel, 0));
  if (!first && static_cast<unsigned>(channel) != of.channel) {
    notes_.push_back(oneLine(path_ + ": " + where + " uses a second set of texture coordinates (" +
                             std::to_string(channel) + "), which is not supported; drawn without it"));
    return out;
  }
  out.image = image(name.C_Str(), where);
  out.wrap_u = wrapOf(u);
  out.wrap_v = wrapOf(v);
  return out;
}

const MeshAppearance::Named& MeshAppearance::material(unsigned index) {
  const auto known = known_materials_.find(index);
  if (known != known_materials_.end()) return named_[known->second];
  const aiMaterial& source = *scene_->mMaterials[index];
  Named out;
  out.name = source.GetName().C_Str();
  aiColor4D color;
  // A colour without a name is a default that importers add to files without one.
  if (source.Get(AI_MATKEY_BASE_COLOR, color) == aiReturn_SUCCESS) {
    out.material.has_color = true;
    out.material.color = {color.r, color.g, color.b};
  } else if (out.name != AI_DEFAULT_MATERIAL_NAME && source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
    out.material.has_color = true;  // other formats give it as displayed
    const auto linear = [](float c) { return static_cast<float>(linearFromSrgb(c)); };
    out.material.color = {linear(color.r), linear(color.g), linear(color.b)};
  }
  out.material.color = out.material.color.cwiseMax(0.F).cwiseMin(1.F);
  source.Get(AI_MATKEY_ROUGHNESS_FACTOR, out.material.roughness);
  source.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), out.material.normal_scale);
  const bool has_base = source.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
  out.material.color_texture =
      texture(source, has_base ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE, "baseColorTexture", out);
  // OBJ: norm; else the texture of map_Bump.
  const bool has_normals = source.GetTextureCount(aiTextureType_NORMALS) > 0;
  if (has_normals) out.material.normal_texture = texture(source, aiTextureType_NORMALS, "normalTexture", out);
  const bool own = source.GetTextureCount(aiTextureType_DIFFUSE_ROUGHNESS) > 0;
  out.material.roughness_texture =
      texture(source, own ? aiTextureType_DIFFUSE_ROUGHNESS : aiTextureType_UNKNOWN, "metallicRoughnessTexture", out);
  known_materials_[index] = static_cast<uint32_t>(detail_.materials.size());
  detail_.materials.push_back(out.material);
  named_.push_back(out);
  return named_.back();
}

void MeshAppearance::addPart(const aiMesh& source, const std::string& name) {
  material_ = kNoChart;
  has_coordinates_ = false;
  if (scene_ != nullptr && source.mMaterialIndex < scene_->mNumMaterials) {
    const Named& of = material(source.mMaterialIndex);
    material_ = known_materials_[source.mMaterialIndex];
    const bool wanted = of.material.hasTexture();
    has_coordinates_ = wanted && of.channel < AI_MAX_NUMBER_OF_TEXTURECOORDS && source.HasTextureCoords(of.channel);
    if (wanted && !has_coordinates_) {
      notes_.push_back(oneLine(path_ + ": part '" + name + "' has no texture coordinates (TEXCOORD_" +
                               std::to_string(of.channel) + ") for the textures of material '" + of.name +
                               "'; drawn in its base colour"));
    }
  }
  detail_.part_materials.push_back(material_);
}

void MeshAppearance::addTriangle(const aiMesh& source, const std::array<Eigen::Vector3d, 3>& corners_m,
                                 const std::array<unsigned, 3>& face) {
  chart_of_triangle_.push_back(kNoChart);
  if (!has_coordinates_) return;
  std::array<Eigen::Vector2d, 3> uv;
  for (size_t i = 0; i < 3; ++i) {
    const aiVector3D& at = source.mTextureCoords[named_[material_].channel][face[i]];
    uv[i] = {at.x, at.y};
    if (uv[i].allFinite() && uv[i].cwiseAbs().maxCoeff() <= kFarthestCoordinate) continue;
    if (!said_no_coordinates_) {
      notes_.push_back(
          oneLine(path_ + ": material '" + named_[material_].name +
                  "': some texture coordinates are not numbers within +-100000; their triangles are drawn in "
                  "the base colour"));
    }
    said_no_coordinates_ = true;
    return;
  }
  chart_of_triangle_.back() = static_cast<uint32_t>(detail_.charts.size());
  detail_.charts.push_back(textureChart(corners_m, uv, material_));
}

void MeshAppearance::giveTo(TriangleMesh& mesh) {
  bool any = false;
  for (const SurfaceMaterial& of : detail_.materials) any = any || of.has_color || of.hasTexture();
  if (!any) return;
  if (!detail_.charts.empty()) mesh.charts = std::move(chart_of_triangle_);
  mesh.detail = std::make_shared<const SurfaceDetail>(std::move(detail_));
}

}  // namespace viscera
