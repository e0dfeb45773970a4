// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// Render target for depths and labels of one camera, with one sample per pixel of the image, as means of either are
/// meaningless. Drawn with shaders/draw/mesh.vert and geometry.frag.
class GeometryTarget {
 public:
  /// @throws GpuError  the driver refuses the size
  GeometryTarget(int width, int height);
  ~GeometryTarget();
  GeometryTarget(const GeometryTarget&) = delete;
  GeometryTarget& operator=(const GeometryTarget&) = delete;

  /// Binds it for drawing and clears it: depth 0, label 0.
  void bindEmpty() const;
  /// Binds one for reading: float, m along the optical axis; or uint8_t (layout/picture_labels.h). 0: nothing is there.
  void bindDepths() const;
  void bindLabels() const;

 private:
  int width_, height_;
  uint32_t framebuffer_ = 0, depths_ = 0, labels_ = 0, depth_buffer_ = 0;
};

}  // namespace viscera
