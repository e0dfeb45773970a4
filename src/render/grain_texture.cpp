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

/// 0..1, the same for the same corner and seed.
float hashed(uint32_t x, uint32_t y, uint32_t z, uint32_t seed) {
  uint32_t h = x * 0x8da6b343U ^ y * 0xd8163841U ^ z * 0xcb1ab31fU ^ seed * 0x9e3779b9U;
  h = (h ^ h >> 15U) * 0x2c1b3c6dU;
  h = (h ^ h >> 12U) * 0x297a2d39U;
  return static_cast<float>((h ^ h >> 15U) >> 8U) / 16777216.0F;
}

/// Values at the corners of a grid of `cells` per period, smooth between them.
float valueNoise(const std::array<float, 3>& at, const std::array<uint32_t, 3>& cells, uint32_t seed) {
  std::array<uint32_t, 3> low{};
  std::array<float, 3> share{};
  for (size_t i = 0; i < 3; ++i) {
    const float place = at[i] * static_cast<float>(cells[i]);
    low[i] = static_cast<uint32_t>(place);
    const float f = place - static_cast<float>(low[i]);
    share[i] = f * f * f * (f * (6 * f - 15) + 10);
  }
  float sum = 0;
  for (uint32_t corner = 0; corner < 8; ++corner) {
    float weight = 1;
    std::array<uint32_t, 3> place{};
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t high = corner >> i & 1U;
      place[i] = (low[i] + high) % cells[i];
      weight *= high ? share[i] : 1 - share[i];
    }
    sum += weight * hashed(place[0], place[1], place[2], seed);
  }
  return sum;
}

/// Octaves of such noise, each twice as fine and half as strong, spread over 0..1.
float octaves(const std::array<float, 3>& at, std::array<uint32_t, 3> cells, int count, uint32_t seed) {
  float sum = 0, strength = 1, whole = 0;
  for (int octave = 0; octave < count; ++octave) {
    sum += strength * (valueNoise(at, cells, seed + static_cast<uint32_t>(octave)) - 0.5F);
    whole += strength;
    strength /= 2;
    for (uint32_t& of : cells) of *= 2;
  }
  constexpr float kContrast = 1.6F;  // sums of noise crowd around their mean
  return std::clamp(0.5F + kContrast * sum / whole, 0.F, 1.F);
}

}  // namespace

std::vector<uint8_t> GrainTexture::texels(int side) {
  std::vector<uint8_t> out;
  out.reserve(size_t{4} * side * side * side);
  const auto byte = [](float value) { return static_cast<uint8_t>(std::lround(255 * value)); };
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto n = static_cast<float>(side);
        const std::array<float, 3> at = {static_cast<float>(x) / n, static_cast<float>(y) / n,
                                         static_cast<float>(z) / n};
        out.push_back(byte(octaves(at, {8, 8, 8}, 2, 1)));
        out.push_back(byte(octaves(at, {8, 8, 8}, 3, 11)));
        out.push_back(byte(octaves(at, {2, 16, 12}, 2, 21)));
        out.push_back(255);
      }
    }
  }
  return out;
}

std::vector<uint8_t> GrainTexture::slopes(const std::vector<uint8_t>& texels, int side) {
  const auto relief = [&](int x, int y, int z) {  // 0..1 stands for -1..1
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

uint32_t makeTexture(const std::vector<uint8_t>& texels, int side) {
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
  const std::vector<uint8_t> grain = texels();
  id_ = makeTexture(grain, kSide);
  if (slopes) slopes_ = makeTexture(GrainTexture::slopes(grain), kSide);
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
