// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/gw/gw_network.h"
#include "gpu/buffer.h"
#include "gpu/program.h"

namespace viscera::bench {

/// A buffer that is read through texel fetches, in any of OpenGL's formats. Move-only.
class TexelArray {
 public:
  TexelArray() = default;
  TexelArray(uint32_t buffer, uint32_t format);
  ~TexelArray();
  TexelArray(TexelArray&& other) noexcept;
  TexelArray& operator=(TexelArray&& other) noexcept;
  void bind(uint32_t unit) const;

 private:
  uint32_t id_ = 0;
};

/// Pixel format into which forces are blended.
enum class BlendFormat { kFixed8, kFloat16, kFloat32 };
const char* nameOf(BlendFormat format);

/// A render target with a pixel per slot, in which blending sums the forces of springs (GW 4.2).
class BlendTarget {
 public:
  /// @param slots  least number of pixels   @param scale_n  force that the value 1 represents; see scaleOf()
  /// @throws GpuError
  BlendTarget(BlendFormat format, size_t slots, double scale_n);
  ~BlendTarget();
  BlendTarget(const BlendTarget&) = delete;
  BlendTarget& operator=(const BlendTarget&) = delete;

  /// Draws every spring at both of its ends. The views with springs and their forces must be bound.
  void add(size_t springs);
  void bindTexture(uint32_t unit) const;
  double scale_n() const { return scale_n_; }
  double zero() const;   ///< value that represents zero force
  Field forces() const;  ///< [slots, N] forces; waits for the GPU

 private:
  void draw(size_t springs, uint32_t end, double sign) const;

  BlendFormat format_;
  size_t slots_;
  double scale_n_;
  uint32_t width_, height_;
  uint32_t texture_ = 0, framebuffer_ = 0, vertices_ = 0;
  gpu::Program program_;
};

/// Returns a scale for forces with partial sums up to a value. It is a power of two, so scaling does not round. Stored
/// values stay within -1/2 and 1/2: a fixed-point target represents 0 to 1 and zero force is at 128/255.
double scaleOf(double largest_sum_n);

}  // namespace viscera::bench
