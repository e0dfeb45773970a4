// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// Returns a texture of one level, clamped to its edge. glGetError() says whether it could be made.
/// @param format, filter  as OpenGL has them
uint32_t makeTexture(uint32_t format, int width, int height, uint32_t filter);

/// Render target for lighting per pixel: 2 x 2 samples per pixel of the visible tissue (shaders/layout/seen.h), the
/// image itself, and 2 x 2 samples of colours over it, for tools.
class GBuffer {
 public:
  static constexpr int kMostPixels = 2000000;  ///< of an image: a pixel takes 136 bytes

  /// @param width, height  of the image [px]   @throws GpuError  the driver refuses the size
  GBuffer(int width, int height);
  ~GBuffer();
  GBuffer(const GBuffer&) = delete;
  GBuffer& operator=(const GBuffer&) = delete;

  /// Binds the samples for drawing, and clears them.
  void bindSeen() const;
  /// Binds the image for drawing; shaders can read the samples. Its depths sort pixels, see DeferredLighting.
  void bindImage() const;
  /// Binds the colours over the image for drawing, with the depths of the samples, and clears them.
  void bindOver() const;
  /// Binds these colours for reading by shaders.
  void readOver() const;
  void bindForReading() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void remove();

  int width_, height_;
  uint32_t positions_ = 0, finishes_ = 0, depths_ = 0, over_color_ = 0;  ///< textures
  uint32_t image_color_ = 0, parts_ = 0;                                 ///< renderbuffers
  uint32_t seen_ = 0, over_ = 0, image_ = 0;                             ///< framebuffers
};

}  // namespace viscera
