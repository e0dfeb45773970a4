// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/triangle_mesh.h"

namespace viscera {

/// Colour of a part of an organ: the organ's colour, a little warmer or cooler and lighter or darker part by part.
Vector3d partColor(const Vector3d& organ_color, size_t part);

/// RGBA8 (red in the low byte, alpha 255) of every vertex; on a seam the colour of the lowest part.
std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color);

}  // namespace viscera
