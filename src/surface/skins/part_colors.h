// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/triangle_mesh.h"
#include "viscera/solver/process_look.h"

namespace viscera {

/// Colour of a part of an organ: the organ's colour, a little warmer or cooler and lighter or darker part by part.
Vector3d partColor(const Vector3d& organ_color, size_t part);

/// The alpha of a body's vertices: shaders/draw/tissue.frag reads of it what a triangle is and whose (bodyOf()).
constexpr uint32_t skinAlpha(uint32_t body, bool two_sided) {
  return two_sided ? body : 255 - body;
}
constexpr uint32_t wallAlpha(uint32_t body) {
  return 160 + body;
}
static_assert(layout::kMaxBodies <= 16);

/// Returns a colour under a paint: burnt tissue is paler as it coagulates, then brown and black; blood is red.
/// @param rgba  without the paint; its alpha stays   @param share  as NodePaint::shares
uint32_t paintedColor(PaintKind kind, uint32_t rgba, float share);

/// As the mesh's file has it (TriangleMesh::detail), where it says nothing by partColor() of the organ's colour.
/// RGBA8 (red in the low byte) of every vertex; on a seam the colour of the lowest part. Alpha is skinAlpha(): the
/// back of a triangle is the raw inside of tissue, or no different from its front, as in a sheet.
std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color, bool two_sided = false,
                                   uint32_t body = 0);

}  // namespace viscera
