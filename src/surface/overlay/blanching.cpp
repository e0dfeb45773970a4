// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/overlay/blanching.h"

#include <algorithm>

#include "layout/bindings.h"
#include "surface/surface_kernels.h"

namespace viscera {

bool Blanching::isSeenIn(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.blanching > 0; });
}

Blanching::Blanching(const Model& model)
    : strains_(model, NodeStrains::Mean::kSigned), color_(surfaceKernel("overlay_colors.comp", {"PALE"})) {
  std::vector<float> blanching(4 * layout::kMaxBodies);
  for (size_t b = 0; b < model.bodies.size(); ++b) blanching[4 * b] = static_cast<float>(model.bodies[b].blanching);
  color_.setVectors("body_blanching", blanching.data(), 4, layout::kMaxBodies);
}

const gpu::Buffer<uint32_t>& Blanching::follow(const StateView& state, const Surface& surface) {
  strains_.follow(state);
  if (colors_.size() < surface.capacity()) colors_ = gpu::Buffer<uint32_t>(surface.capacity(), "pale colors");
  surface.bindings().bindStorage(layout::kBindSkinBindings);
  surface.colors().bindStorage(layout::kBindSkinColors);
  colors_.bindStorage(layout::kBindStrainColors);
  runOver(color_, surface.vertices());
  return colors_;
}

}  // namespace viscera
