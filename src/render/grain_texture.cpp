// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/grain_texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "gpu/gl.h"
#include "layout/bindings.h"
#include "layout/seen.h"
#include "viscera/gpu/context.h"

namespace viscera {

namespace {

/// Returns a hash of a corner and a seed, 0..1.
float hashed(uint32_t x, uint32_t y, uint32_t z, uint32_t seed) {
  uint32_t h = x * 0x8da6b343U ^ y * 0xd8163841U ^ z * 0xcb1ab31fU ^ seed * 0x9e3779b9U;
  h = (h ^ h >> 15U) * 0x2c1b3c6dU;
  h = (h ^ h >> 12U) * 0x297a2d39U;
  return static_cast<float>((h ^ h >> 15U) >> 8U) / 16777216.0F;
}

/// Adds smooth noise to all texels: random values at the corners of a grid of `cells` per period.
void addNoise(std::vector<float>& sums, int side, const std::array<uint32_t, 3>& cells, uint32_t seed, float strength) {
  std::vector<float> corners;
  corners.reserve(size_t{cells[0]} * cells[1] * cells[2]);
  for (uint32_t z = 0; z < cells[2]; ++z)
    for (uint32_t y = 0; y < cells[1]; ++y)
      for (uint32_t x = 0; x < cells[0]; ++x) corners.push_back(hashed(x, y, z, seed));
  struct Position {
    std::array<size_t, 2> corner;  ///< below and above
    std::array<float, 2> weight;
  };
  std::array<std::vector<Position>, 3> positions;  // [side] along each axis
  for (size_t axis = 0, stride = 1; axis < 3; stride *= cells[axis++]) {
    for (int i = 0; i < side; ++i) {
      const float position = static_cast<float>(i) / static_cast<float>(side) * static_cast<float>(cells[axis]);
      const auto low = static_cast<uint32_t>(position);
      const float f = position - static_cast<float>(low), share = f * f * f * (f * (6 * f - 15) + 10);
      positions[axis].push_back({{low % cells[axis] * stride, (low + 1) % cells[axis] * stride}, {1 - share, share}});
    }
  }
  size_t texel = 0;
  for (const Position& z : positions[2]) {
    for (const Position& y : positions[1]) {
      for (const Position& x : positions[0]) {
        float sum = 0;
        for (uint32_t corner = 0; corner < 8; ++corner) {
          const uint32_t i = corner & 1U, j = corner >> 1U & 1U, k = corner >> 2U;
          sum += x.weight[i] * y.weight[j] * z.weight[k] * corners[x.corner[i] + y.corner[j] + z.corner[k]];
        }
        sums[texel++] += strength * (sum - 0.5F);
      }
    }
  }
}

/// Returns octaves of such noise, each twice as fine and half as strong, scaled to 0..255.
std::vector<uint8_t> octaves(int side, std::array<uint32_t, 3> cells, int count, uint32_t seed) {
  std::vector<float> sums(static_cast<size_t>(side) * side * side);
  float strength = 1, whole = 0;
  for (int octave = 0; octave < count; ++octave) {
    addNoise(sums, side, cells, seed + static_cast<uint32_t>(octave), strength);
    whole += strength;
    strength /= 2;
    for (uint32_t& of : cells) of *= 2;
  }
  constexpr float kContrast = 1.6F;  // sums of noise cluster around their mean
  std::vector<uint8_t> out;
  out.reserve(sums.size());
  for (const float sum : sums)
    out.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(0.5F + kContrast * sum / whole, 0.F, 1.F))));
  return out;
}

}  // namespace

std::vector<uint8_t> GrainTexture::texels(int side) {
  const std::array<std::vector<uint8_t>, 3> channels = {octaves(side, {8, 8, 8}, 2, 1), octaves(side, {8, 8, 8}, 3, 11),
                                                        octaves(side, {2, 16, 12}, 2, 21)};
  std::vector<uint8_t> out(4 * channels[0].size(), 255);
  for (size_t c = 0; c < channels.size(); ++c)
    for (size_t i = 0; i < channels[c].size(); ++i) out[4 * i + c] = channels[c][i];
  return out;
}

std::vector<uint8_t> GrainTexture::slopes(const std::vector<uint8_t>& texels, int side) {
  const auto relief = [&](int x, int y, int z) {  // 0..1 encodes -1..1
    const auto wrapped = [side](int i) { return static_cast<size_t>((i + side) % side); };
    const size_t at =
        4 * ((wrapped(z) * static_cast<size_t>(side) + wrapped(y)) * static_cast<size_t>(side) + wrapped(x));
    return (2 * static_cast<float>(texels[at + 1]) + static_cast<float>(texels[at])) / 255;
  };
  const float per_texel = static_cast<float>(side) * 127 / kSteepest;
  const auto byte = [&](int x, int y, int z, int dx, int dy,
                        int dz) {  // of fourth order: the relief is a few texels fine
    const auto rise = [&](int i) {
      return relief(x + i * dx, y + i * dy, z + i * dz) - relief(x - i * dx, y - i * dy, z - i * dz);
    };
    const float slope = (8 * rise(1) - rise(2)) / 12;
    return static_cast<uint8_t>(128 + std::clamp<long>(std::lround(slope * per_texel), -127, 127));
  };
  std::vector<uint8_t> out;
  out.reserve(texels.size());
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        out.push_back(byte(x, y, z, 1, 0, 0));
        out.push_back(byte(x, y, z, 0, 1, 0));
        out.push_back(byte(x, y, z, 0, 0, 1));
        out.push_back(255);
      }
    }
  }
  return out;
}

namespace {

uint32_t makeGrainTexture(const std::vector<uint8_t>& texels, int side) {
  const int levels = 1 + static_cast<int>(std::lround(std::log2(side)));
  uint32_t id = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &id);
  gpu::countObject();
  glTextureStorage3D(id, levels, GL_RGBA8, side, side, side);
  gpu::checkErrors("the texture of tissue's grain");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage3D(id, 0, 0, 0, 0, side, side, side, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(id, axis, GL_REPEAT);
  // The nearer level alone: half the texels of a blend of two, on a software rasteriser half the time.
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateTextureMipmap(id);
  return id;
}

}  // namespace

GrainTexture::GrainTexture(bool slopes) {
  static const std::vector<uint8_t> grain = texels();  // shared by all sessions of a process
  id_ = makeGrainTexture(grain, kSide);
  if (!slopes) return;
  static const std::vector<uint8_t> rises = GrainTexture::slopes(grain);
  slopes_ = makeGrainTexture(rises, kSide);
}

GrainTexture::~GrainTexture() {
  glDeleteTextures(1, &id_);
  if (slopes_) glDeleteTextures(1, &slopes_);
}

void GrainTexture::bind() const {
  glBindTextureUnit(layout::kUnitGrain, id_);
}

void GrainTexture::bindSlopes() const {
  glBindTextureUnit(layout::kUnitGrainSlopes, slopes_);
}

}  // namespace viscera
