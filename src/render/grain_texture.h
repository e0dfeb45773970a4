// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera {

/// 3-D noise for shaders/draw/grain.glsl: periodic, mipmapped, the same in every run. Move-only.
class GrainTexture {
 public:
  /// Needs a current context. @param slopes  makes slopes of its relief too
  explicit GrainTexture(bool slopes);
  ~GrainTexture();
  GrainTexture(const GrainTexture&) = delete;
  GrainTexture& operator=(const GrainTexture&) = delete;
  void bind() const;
  void bindSlopes() const;  ///< for shaders/draw/deferred_lighting.frag

  static constexpr int kSide = 64;
  /// Returns [4 * side^3] bytes, x fastest: patches, patches with finer ones, fibres along x, 255.
  static std::vector<uint8_t> texels(int side = kSide);
  /// Returns [4 * side^3] bytes: slopes along x, y and z of the relief of such texels, which reliefAt() in grain.glsl
  /// defines: 128 is 0, 255 kSteepest per period.
  static std::vector<uint8_t> slopes(const std::vector<uint8_t>& texels, int side = kSide);
  static constexpr float kSteepest = 48;

 private:
  uint32_t id_ = 0, slopes_ = 0;
};

}  // namespace viscera
