// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Returns the exact surface of an axis-aligned box, closed and facing outward, in squares of two triangles.
/// @param squares  numbers along x, y, z, each at least 1
TriangleMesh boxSurface(const Vector3d& min_m, const Vector3d& size_m, const Vector3i& squares);

}  // namespace viscera
