// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera {

/// Noise in space for shaders/draw/grain.glsl: periodic, mipmapped, the same in every run. Move-only.
class GrainTexture {
 public:
  GrainTexture();  ///< needs a current context
  ~GrainTexture();
  GrainTexture(const GrainTexture&) = delete;
  GrainTexture& operator=(const GrainTexture&) = delete;
  void bind() const;

  static constexpr int kSide = 64;
  /// [4 * side^3] bytes, x fastest: patches, patches and finer ones, fibres along x, 255.
  static std::vector<uint8_t> texels(int side = kSide);

 private:
  uint32_t id_ = 0;
};

}  // namespace viscera
