// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "viscera/layout/skin.h"
#include "viscera/model/model.h"
#include "viscera/solver/process_visuals.h"

namespace viscera {

/// Vertices of surface meshes and walls, as they are drawn.
struct SkinPaint {
  std::vector<uint32_t> colors;     ///< [vertices] RGBA8; alpha as skinAlpha()
  std::vector<layout::vec4> rests;  ///< [vertices] as JoinedSkins::rests and Wounds::addedRests()
};

/// Paints vertices: their colours, and where a surface is burnt its rest.w: minus the share
/// (shaders/draw/skin_paint.glsl). Painted walls have no layers, as their vertices count as deep.
/// @param bindings  [vertices]
void paintSkin(const Model& model, const std::vector<std::shared_ptr<const NodePaint>>& paints,
               const std::vector<layout::SkinBinding>& bindings, SkinPaint& skin);

}  // namespace viscera
