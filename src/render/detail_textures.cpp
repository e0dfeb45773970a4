// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/detail_textures.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "gpu/gl.h"
#include "gpu/software.h"
#include "layout/bindings.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kLargestSide_px = 4096;  // of an array: 16 layers of it are 1.4 GB with their mipmaps
// Texels along the line of sight, for sharpness at a slant. A software rasteriser pays for each.
constexpr float kAnisotropy = 4;

layout::vec4 texel(float x, float y, float z, float w) {
  return {x, y, z, w};
}

/// Computes texel (x, y) of an image resized to another size: bilinear, periodic.
void resampled(const TextureImage& image, int width, int height, int x, int y, uint8_t* out) {
  const auto split = [](double at, int count) {
    const double lower = std::floor(at);
    const int first = (static_cast<int>(lower) % count + count) % count;
    return std::make_pair(first, at - lower);
  };
  const auto [column, right] = split((x + 0.5) * image.width_px / width - 0.5, image.width_px);
  const auto [row, up] = split((y + 0.5) * image.height_px / height - 0.5, image.height_px);
  const int columns[] = {column, (column + 1) % image.width_px}, rows[] = {row, (row + 1) % image.height_px};
  for (int c = 0; c < 4; ++c) {
    double sum = 0;
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        const size_t at = size_t{4} * (static_cast<size_t>(rows[j]) * image.width_px + columns[i]) + c;
        sum += (i ? right : 1 - right) * (j ? up : 1 - up) * image.rgba[at];
      }
    }
    out[c] = static_cast<uint8_t>(std::lround(sum));
  }
}

std::vector<uint8_t> resampled(const TextureImage* image, int width, int height) {
  std::vector<uint8_t> out(size_t{4} * width * height);
  if (image == nullptr) {
    for (size_t i = 0; i < out.size(); i += 4) {
      out[i] = out[i + 1] = 128;  // a normal that is the triangle's own
      out[i + 2] = out[i + 3] = 255;
    }
  } else if (image->width_px == width && image->height_px == height) {
    out = image->rgba;
  } else {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) resampled(*image, width, height, x, y, &out[4 * (size_t(y) * width + x)]);
    }
  }
  return out;
}

}  // namespace

TextureArray::TextureArray(int width_px, int height_px, size_t layers, bool srgb)
    : width_px_(width_px), height_px_(height_px) {
  const int levels = 1 + static_cast<int>(std::log2(std::max(width_px, height_px)));
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id_);
  gpu::countObject();
  glTextureStorage3D(id_, levels, srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, width_px, height_px, static_cast<GLsizei>(layers));
  const GLenum code = glGetError();
  if (code != GL_NO_ERROR) {
    throw GpuError("cannot create a texture of " + std::to_string(layers) + " images of " + std::to_string(width_px) +
                   " x " + std::to_string(height_px) + " pixels: " + gpu::glErrorText(code) +
                   "; use smaller images, or bodies[].textures: false");
  }
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  if (GLEW_EXT_texture_filter_anisotropic && !gpu::isSoftware())
    glTextureParameterf(id_, GL_TEXTURE_MAX_ANISOTROPY_EXT, kAnisotropy);
}

TextureArray::~TextureArray() {
  if (id_) glDeleteTextures(1, &id_);
}

TextureArray::TextureArray(TextureArray&& other) noexcept {
  *this = std::move(other);
}

TextureArray& TextureArray::operator=(TextureArray&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(width_px_, other.width_px_);
  std::swap(height_px_, other.height_px_);
  return *this;
}

void TextureArray::write(size_t layer, const std::vector<uint8_t>& rgba) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage3D(id_, 0, 0, 0, static_cast<GLint>(layer), width_px_, height_px_, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                      rgba.data());
}

void TextureArray::makeMipmaps() {
  glGenerateTextureMipmap(id_);
}

DetailTextures::DetailTextures(const Model& model) {
  for (const Body& body : model.bodies) {
    if (body.skin.mesh.detail) addBody(*body.skin.mesh.detail);
  }
  if (chart_texels_.empty()) return;
  charts_ = gpu::Buffer<layout::vec4>(chart_texels_, "texture charts");
  materials_ = gpu::Buffer<layout::vec4>(material_texels_, "materials");
  charts_view_ = gpu::TexelView(charts_.raw(), gpu::TexelFormat::kRgba32f);
  materials_view_ = gpu::TexelView(materials_.raw(), gpu::TexelFormat::kRgba32f);
  colors_ = arrayOf(color_layers_, true);
  reliefs_ = arrayOf(relief_layers_, false);
  chart_texels_ = material_texels_ = {};
}

float DetailTextures::layerOf(const Layer& layer, std::vector<Layer>& layers) {
  if (layer == Layer{}) return -1;
  const auto found = std::find(layers.begin(), layers.end(), layer);
  const auto index = found - layers.begin();
  if (found == layers.end()) layers.push_back(layer);
  return static_cast<float>(index);
}

/// Adds three texels per material: linear colour and roughness; layers of colours and reliefs, scale of the relief, and
/// whether it has a colour (1) or its image covers the body's own colour (2); how coordinates wrap, of colours and of
/// reliefs.
void DetailTextures::addBody(const SurfaceDetail& detail) {
  const auto picture = [&](const MaterialTexture& of) {
    return of.image < 0 ? nullptr : &detail.images[static_cast<size_t>(of.image)];
  };
  const auto mode = [](TextureWrap wrap) { return static_cast<float>(wrap); };
  for (const SurfaceMaterial& of : detail.materials) {
    const float color_layer = layerOf({picture(of.color_texture), nullptr}, color_layers_);
    const float relief_layer = layerOf({picture(of.normal_texture), picture(of.roughness_texture)}, relief_layers_);
    const MaterialTexture& relief = of.normal_texture.image >= 0 ? of.normal_texture : of.roughness_texture;
    material_texels_.push_back(texel(of.color[0], of.color[1], of.color[2], of.roughness));
    material_texels_.push_back(texel(color_layer, relief_layer, of.normal_scale, of.covers ? 2 : of.has_color ? 1 : 0));
    material_texels_.push_back(
        texel(mode(of.color_texture.wrap_u), mode(of.color_texture.wrap_v), mode(relief.wrap_u), mode(relief.wrap_v)));
  }
  for (const TextureChart& chart : detail.charts) {
    for (const Eigen::Vector4f& of : {chart.u, chart.v}) chart_texels_.push_back(texel(of[0], of[1], of[2], of[3]));
    chart_texels_.push_back(texel(static_cast<float>(materials_before_ + chart.material), 0, 0, 0));
  }
  materials_before_ += static_cast<uint32_t>(detail.materials.size());
}

/// Returns an array of the layers, or one texel where there are none, as samplers must be bound.
TextureArray DetailTextures::arrayOf(const std::vector<Layer>& layers, bool srgb) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  int width = 1, height = 1;
  for (const Layer& layer : layers) {
    for (const TextureImage* image : {layer.picture, layer.roughness}) {
      if (image == nullptr) continue;
      width = std::min({std::max(width, image->width_px), kLargestSide_px, most});
      height = std::min({std::max(height, image->height_px), kLargestSide_px, most});
    }
  }
  TextureArray array(width, height, std::max<size_t>(layers.size(), 1), srgb);
  for (size_t i = 0; i < layers.size(); ++i) {
    std::vector<uint8_t> rgba = resampled(layers[i].picture, width, height);
    if (!srgb) {  // the normal's alpha is the roughness, from green of its own image
      const std::vector<uint8_t> rough =
          layers[i].roughness ? resampled(layers[i].roughness, width, height) : std::vector<uint8_t>();
      for (size_t t = 0; t < rgba.size(); t += 4) rgba[t + 3] = rough.empty() ? 255 : rough[t + 1];
    }
    array.write(i, rgba);
  }
  array.makeMipmaps();
  return array;
}

void DetailTextures::bind() const {
  charts_view_.bind(layout::kUnitCharts);
  materials_view_.bind(layout::kUnitMaterials);
  glBindTextureUnit(layout::kUnitColors, colors_.id());
  glBindTextureUnit(layout::kUnitReliefs, reliefs_.id());
}

}  // namespace viscera
