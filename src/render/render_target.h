// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// Render target for one camera's image: sRGB colour and depth, larger than the image on request. Move-only.
class RenderTarget {
 public:
  /// @param width, height   of the image [px]
  /// @param supersampling   drawn pixels per image pixel and axis: 1 or 2
  /// @throws GpuError  the driver refuses the size
  RenderTarget(int width, int height, int supersampling);
  ~RenderTarget();
  RenderTarget(RenderTarget&& other) noexcept;
  RenderTarget& operator=(RenderTarget&& other) noexcept;

  /// Binds it for drawing.
  void bindForDrawing() const;
  /// Averages the drawn pixels of each image pixel in linear light, and binds the image for reading.
  void resolve() const;
  /// Binds the last resolved image for reading.
  void bindForReading() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  RenderTarget() = default;

  uint32_t drawn_ = 0, drawn_color_ = 0, drawn_depth_ = 0;  // framebuffer and its renderbuffers
  uint32_t image_ = 0, image_color_ = 0;                    // 0 where the image is drawn at its own size
  int width_ = 0, height_ = 0, supersampling_ = 1;
};

}  // namespace viscera
