// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// A texture of one level, beyond whose sides its last pixels go on. glGetError() says whether there is one.
/// @param format, filter  as OpenGL has them
uint32_t makeTexture(uint32_t format, int width, int height, uint32_t filter);

/// Where the image of a camera is drawn whose pixels are lit once: 2 x 2 samples per pixel of what is seen of tissue
/// (shaders/layout/seen.h), the image itself, and 2 x 2 samples of colours over it, for tools.
class SeenTarget {
 public:
  static constexpr int kMostPixels = 2000000;  ///< of an image: a pixel takes 136 bytes

  /// @param width, height  of the image [px]   @throws GpuError  the driver refuses the size
  SeenTarget(int width, int height);
  ~SeenTarget();
  SeenTarget(const SeenTarget&) = delete;
  SeenTarget& operator=(const SeenTarget&) = delete;

  /// Makes the samples the place to draw to, with nothing in them.
  void bindSeen() const;
  /// Makes the image the place to draw to, which shaders can read. Its depths part pixels, see SeenLight.
  void bindImage() const;
  /// Makes the colours over it the place to draw to, behind what has been seen, with nothing in them.
  void bindOver() const;
  /// Lets shaders read the colours.
  void readOver() const;
  void bindForReading() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void remove();

  int width_, height_;
  uint32_t places_ = 0, finishes_ = 0, depths_ = 0, over_color_ = 0;  ///< textures
  uint32_t image_color_ = 0, parts_ = 0;                              ///< renderbuffers
  uint32_t seen_ = 0, over_ = 0, image_ = 0;                          ///< framebuffers
};

}  // namespace viscera
