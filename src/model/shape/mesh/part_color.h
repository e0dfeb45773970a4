// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "math/srgb.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/surface_detail.h"

namespace viscera {

/// Gives a part of a mesh a colour where it has no texture. @param color  sRGB, 0..1
inline void addPartColor(size_t part, const Vector3d& color, SurfaceDetail& detail) {
  if (detail.part_materials.size() <= part) detail.part_materials.resize(part + 1, kNoChart);
  detail.part_materials[part] = static_cast<uint32_t>(detail.materials.size());
  SurfaceMaterial material;
  material.has_color = true;
  material.color = color.unaryExpr(&linearFromSrgb).cast<float>();
  detail.materials.push_back(material);
}

}  // namespace viscera
