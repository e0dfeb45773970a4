// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera {

/// Noise in space for shaders/draw/grain.glsl: periodic, mipmapped, the same in every run. Move-only.
class GrainTexture {
 public:
  /// Needs a current context. @param slopes  of its relief are wanted too
  explicit GrainTexture(bool slopes);
  ~GrainTexture();
  GrainTexture(const GrainTexture&) = delete;
  GrainTexture& operator=(const GrainTexture&) = delete;
  void bind() const;
  void bindSlopes() const;  ///< for shaders/draw/seen_light.frag

  static constexpr int kSide = 64;
  /// [4 * side^3] bytes, x fastest: patches, patches and finer ones, fibres along x, 255.
  static std::vector<uint8_t> texels(int side = kSide);
  /// [4 * side^3] bytes: how the relief of such texels, as reliefAt() in grain.glsl puts it together, rises along x, y
  /// and z: 128 is 0, 255 kSteepest per period.
  static std::vector<uint8_t> slopes(const std::vector<uint8_t>& texels, int side = kSide);
  static constexpr float kSteepest = 48;

 private:
  uint32_t id_ = 0, slopes_ = 0;
};

}  // namespace viscera
