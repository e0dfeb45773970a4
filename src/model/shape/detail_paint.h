// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "viscera/model/shape/solid.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// What is painted on a place of a surface.
struct PaintedSpot {
  Vector3f color = Vector3f::Zero();  ///< linear
  float cover = 0;                    ///< 0..1: how much of the body's own colour it hides
  float height_m = 0;                 ///< above the surface, for its shading normal
};
/// Of a place at rest [m] with its outward unit normal; asked by several threads at once.
using SurfacePaint = std::function<PaintedSpot(const Vector3f& place_m, const Vector3f& normal)>;

/// The skin with a picture and a normal map of what is painted on it, as bakeDetail() makes them of a mesh.
/// @param largest_px  side of the square of texels, at most
/// @throws MeshError  the skin has more triangles than fit there
TriangleMesh paintDetail(const TriangleMesh& skin, const SurfacePaint& paint, int largest_px,
                         const Progress& progress = {});

}  // namespace viscera
