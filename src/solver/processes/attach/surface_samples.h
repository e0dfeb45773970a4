// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// A small area of a surface.
struct SurfaceSample {
  Vector3d at_m = Vector3d::Zero();    ///< its middle
  Vector3d normal = Vector3d::Zero();  ///< unit, outward
  double area_m2 = 0;
};

/// Divides a surface by a grid of cubes and by the direction in which it faces. The areas add up to that of the
/// triangles.
/// @param edge_m, origin_m  of the cubes   @param wanted  returns whether a ball around a triangle may matter:
/// centre, radius [m]   @returns samples in the order of their cubes
std::vector<SurfaceSample> samplesOf(const TriangleMesh& mesh, double edge_m, const Vector3d& origin_m,
                                     const std::function<bool(const Vector3d&, double)>& wanted);

}  // namespace viscera
