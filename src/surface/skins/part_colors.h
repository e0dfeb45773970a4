// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/math/types.h"
#include "viscera/model/model.h"
#include "viscera/model/shape/triangle_mesh.h"
#include "viscera/solver/process_visuals.h"

namespace viscera {

/// Returns the colour of a part of an organ: the organ's colour, part by part a little warmer or cooler and lighter or
/// darker.
Vector3d partColor(const Vector3d& organ_color, size_t part);

/// Returns the alpha of a body's vertices, from which shaders/draw/tissue.frag reads the kind and the body of a
/// triangle (bodyOf()).
constexpr uint32_t skinAlpha(uint32_t body, bool two_sided) {
  return two_sided ? body : 255 - body;
}
constexpr uint32_t wallAlpha(uint32_t body) {
  return 160 + body;
}
constexpr bool isWallAlpha(uint32_t alpha) {
  return alpha >= wallAlpha(0) && alpha < wallAlpha(layout::kMaxBodies);
}
constexpr float kOnLip =
    1;  ///< of a vertex of a surface at the edge of a cut: its rest.w (shaders/draw/skin_paint.glsl)
constexpr uint32_t bodyOfAlpha(uint32_t alpha) {
  return alpha >= 240 ? 255 - alpha : alpha >= 160 ? alpha - 160 : alpha;
}
static_assert(layout::kMaxBodies <= 16);

/// Returns a colour under a paint: burnt tissue is paler as it coagulates, then brown and black; blood is
/// red, bile yellow-green.
/// @param rgba  without the paint; its alpha stays   @param share  as NodePaint::shares
uint32_t paintedColor(PaintKind kind, uint32_t rgba, float share);

/// Returns the colour of every vertex, RGBA8 (red in the low byte): from the mesh's file (TriangleMesh::detail) or,
/// where it has none, by partColor() of the organ's colour. On a seam it is the colour of the lowest part. Alpha is
/// skinAlpha(): the back of a triangle is the raw inside of tissue or, in a sheet, looks like its front.
std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color, bool two_sided = false,
                                   uint32_t body = 0);

/// Returns the colours of the inside [labels of the lattice], which walls of wounds show below the layers: woundColor()
/// of each part's own colour, else of the body's.
std::vector<Vector3d> insideColors(const Body& body);
/// Returns whether parts of the body have colours of their own without textures.
bool hasPartColors(const Body& body);

}  // namespace viscera
