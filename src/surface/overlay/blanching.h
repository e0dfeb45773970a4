// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface/overlay/node_strains.h"
#include "surface/surface.h"

namespace viscera {

/// Colours of a surface that loses its blood where it is pressed (BodyConfig::blanching). Owner of
/// shaders/surface/overlay_colors.comp with PALE.
class Blanching {
 public:
  /// Returns whether any body blanches.
  static bool isSeenIn(const Model& model);
  /// Needs a current context. @throws GpuError
  explicit Blanching(const Model& model);

  /// Computes the colours of a state. @param surface  that follows it
  /// @returns  [vertices] RGBA8, the surface's own where nothing is pressed
  const gpu::Buffer<uint32_t>& follow(const StateView& state, const Surface& surface);

 private:
  NodeStrains strains_;
  gpu::Program color_;
  gpu::Buffer<uint32_t> colors_;
};

}  // namespace viscera
