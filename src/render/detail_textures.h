// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "viscera/model/model.h"

namespace viscera {

/// Array texture with mipmaps, one image per layer. Move-only.
class TextureArray {
 public:
  TextureArray() = default;
  /// @param srgb  texels are colours for a screen
  /// @throws GpuError  the driver refuses the size
  TextureArray(int width_px, int height_px, size_t layers, bool srgb);
  ~TextureArray();
  TextureArray(TextureArray&& other) noexcept;
  TextureArray& operator=(TextureArray&& other) noexcept;

  /// Writes a layer. @param rgba  [4 * width * height]
  void write(size_t layer, const std::vector<uint8_t>& rgba);
  void makeMipmaps();
  int width() const { return width_px_; }
  int height() const { return height_px_; }
  uint32_t id() const { return id_; }

 private:
  uint32_t id_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

/// Materials, texture charts and textures of a model's surface meshes on the GPU, numbered as in JoinedSkins::charts.
/// shaders/draw/detail.glsl reads them.
///
/// All images of a kind are layers of one array, as large as the largest: the others are enlarged.
class DetailTextures {
 public:
  explicit DetailTextures(const Model& model);
  /// Returns whether there is any chart. Without one nothing is allocated or bound.
  bool any() const { return charts_view_.id() != 0; }
  void bind() const;

 private:
  void addBody(const SurfaceDetail& detail);

  /// A future layer: images of one material, or of several that share them.
  struct Layer {
    const TextureImage* picture = nullptr;    ///< colours, or normals; null: flat
    const TextureImage* roughness = nullptr;  ///< null: 1
    bool operator==(const Layer& o) const { return picture == o.picture && roughness == o.roughness; }
  };
  static float layerOf(const Layer& layer, std::vector<Layer>& layers);
  static TextureArray arrayOf(const std::vector<Layer>& layers, bool srgb);

  std::vector<layout::vec4> chart_texels_, material_texels_;
  std::vector<Layer> color_layers_, relief_layers_;
  uint32_t materials_before_ = 0;
  gpu::Buffer<layout::vec4> charts_, materials_;
  gpu::TexelView charts_view_, materials_view_;
  TextureArray colors_, reliefs_;
};

}  // namespace viscera
