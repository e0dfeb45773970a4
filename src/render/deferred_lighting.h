// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "render/g_buffer.h"
#include "render/vertex_array.h"
#include "viscera/render/camera.h"

namespace viscera {

/// Deferred lighting: lights pixels with samples of one surface once, and those at edges sample by sample. Owner of
/// shaders/draw/whole.vert, pixel_classes.frag, deferred_lighting.frag, over.frag.
class DeferredLighting {
 public:
  /// Slope relative to the image plane, above which neighbouring samples count as several surfaces.
  static constexpr float kSteepest = 10;

  /// @param features  GRAIN, DETAIL
  explicit DeferredLighting(const std::vector<std::string>& features);
  /// Returns the lighting programs, to set uniforms of the caller.
  std::array<const gpu::Program*, 2> programs() const { return {&one_, &several_}; }
  /// Lights an image. Textures of tissue must be bound. Leaves the image bound for drawing; its depths are not those of
  /// the tissue.
  /// @param background  linear
  /// @param pause  called between passes, unless empty
  void light(const GBuffer& target, const CameraConfig& camera, const Pose& optical_from_tissue,
             const float (&background)[4], const std::function<void()>& pause) const;
  /// Draws the colours of bindOver() over the tissue.
  void putOver(const GBuffer& target) const;

 private:
  gpu::Program parts_, one_, several_, over_;
  VertexArray nothing_;
};

}  // namespace viscera
