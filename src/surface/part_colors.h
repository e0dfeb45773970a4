// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Colour of a part of an organ: the organ's colour, a little warmer or cooler and lighter or darker part by part.
Vector3d partColor(const Vector3d& organ_color, size_t part);

/// RGBA8 (red in the low byte) of every vertex; on a seam the colour of the lowest part. Alpha says what the back of a
/// triangle looks like: 255 the raw inside of tissue, 0 no different from its front, as in a sheet.
std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color, bool two_sided = false);

}  // namespace viscera
