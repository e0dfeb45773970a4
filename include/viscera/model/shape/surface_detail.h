// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Image on a surface: four bytes per texel, rows from v = 0 upwards.
struct TextureImage {
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgba;  ///< [4 * width * height]
};

/// Treatment of texture coordinates outside 0..1.
enum class TextureWrap : uint8_t { kRepeat, kMirror, kClamp };

/// One image of a material.
struct MaterialTexture {
  int image = -1;  ///< index into SurfaceDetail::images; -1: none
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
};

/// Appearance of a surface as the author of the mesh set it (glTF 2.0, metallic-roughness; tissue is no metal).
struct SurfaceMaterial {
  bool has_color = false;                           ///< false: the body's own colour
  Eigen::Vector3f color = Eigen::Vector3f::Ones();  ///< linear colour; multiplies color_texture
  float roughness = -1;               ///< roughness 0..1, multiplies the texture's green channel; -1: the body's own
  float normal_scale = 1;             ///< scale of the normal map's x and y
  MaterialTexture color_texture;      ///< sRGB
  MaterialTexture normal_texture;     ///< x, y, z of the normal in (T, B, N); 0..255 means -1..1
  MaterialTexture roughness_texture;  ///< green channel
  bool covers = false;  ///< color_texture covers the body's own colour by its alpha, instead of multiplying a colour
  bool hasTexture() const {
    return color_texture.image >= 0 || normal_texture.image >= 0 || roughness_texture.image >= 0;
  }
};

/// Texture coordinates as affine functions of the rest position, u = u.xyz * p + u.w. A triangle and all pieces that it
/// is split into share them, so that vertices need not be split where coordinates jump.
struct TextureChart {
  Eigen::Vector4f u = Eigen::Vector4f::Zero(), v = Eigen::Vector4f::Zero();  ///< xyz [1/m], w [1]
  uint32_t material = 0;
};
constexpr uint32_t kNoChart = UINT32_MAX;

/// Appearance of a surface beyond its triangles (VR05 2.6). Immutable after construction.
struct SurfaceDetail {
  std::vector<TextureImage> images;
  std::vector<SurfaceMaterial> materials;
  std::vector<TextureChart> charts;  ///< charts; TriangleMesh::charts gives the chart of each triangle
  /// [parts] material of each part, or kNoChart: its colour where there is no texture.
  std::vector<uint32_t> part_materials;
};

/// Returns the chart that takes given coordinates at a triangle's corners; constant where the triangle has no area.
/// @param corners_m  [3] at rest, tissue frame   @param uv  [3]
TextureChart textureChart(const std::array<Eigen::Vector3d, 3>& corners_m, const std::array<Eigen::Vector2d, 3>& uv,
                          uint32_t material);

}  // namespace viscera
