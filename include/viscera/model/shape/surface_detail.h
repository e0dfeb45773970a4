// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace viscera {

/// A picture that lies on a surface: four bytes a texel, rows from v = 0 upwards.
struct TextureImage {
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgba;  ///< [4 * width * height]
};

/// What becomes of texture coordinates outside of 0..1.
enum class TextureWrap : uint8_t { kRepeat, kMirror, kClamp };

/// One picture of a material.
struct MaterialTexture {
  int image = -1;  ///< index into SurfaceDetail::images; -1: none
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
};

/// What a mesh's author says of a surface (glTF 2.0, metallic-roughness; tissue is no metal).
struct SurfaceMaterial {
  bool has_color = false;                           ///< else the body's own
  Eigen::Vector3f color = Eigen::Vector3f::Ones();  ///< linear; multiplies color_texture
  float roughness = -1;                             ///< 0..1, multiplies the texture's green; -1: the body's own
  float normal_scale = 1;                           ///< of the normal map's x and y
  MaterialTexture color_texture;                    ///< sRGB
  MaterialTexture normal_texture;                   ///< x, y, z of the normal in (T, B, N), 0..255 for -1..1
  MaterialTexture roughness_texture;                ///< green
  bool covers = false;  ///< color_texture hides the body's own colour by its alpha, instead of multiplying one
  bool hasTexture() const {
    return color_texture.image >= 0 || normal_texture.image >= 0 || roughness_texture.image >= 0;
  }
};

/// Texture coordinates as affine functions of the rest position, u = u.xyz * p + u.w: the same for a triangle and all
/// pieces that it is ever split into, so that vertices need not be split where coordinates jump.
struct TextureChart {
  Eigen::Vector4f u = Eigen::Vector4f::Zero(), v = Eigen::Vector4f::Zero();  ///< 1/m, and 1
  uint32_t material = 0;
};
constexpr uint32_t kNoChart = UINT32_MAX;

/// What a surface looks like beyond its triangles (VR05 2.6). Never changed once it is there.
struct SurfaceDetail {
  std::vector<TextureImage> images;
  std::vector<SurfaceMaterial> materials;
  std::vector<TextureChart> charts;      ///< TriangleMesh::charts says which triangle has which
  std::vector<uint32_t> part_materials;  ///< [parts] of each part, or kNoChart: its colour where no texture is
};

/// The coordinates that take given values at a triangle's corners; constant where it has no area.
/// @param corners_m  [3] at rest, tissue frame   @param uv  [3]
TextureChart textureChart(const std::array<Eigen::Vector3d, 3>& corners_m, const std::array<Eigen::Vector2d, 3>& uv,
                          uint32_t material);

}  // namespace viscera
