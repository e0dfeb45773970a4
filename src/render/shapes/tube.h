// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "render/shapes/tool_shape.h"

namespace viscera {

constexpr size_t kTubeSides = 8;
/// Returns the number of vertices that addTube() appends. @param points  > 0
constexpr size_t tubeVertices(size_t points) {
  return (points + 2) * kTubeSides;
}

/// Appends a tube along points, with closed ends, to a shape; all in the frame of the points.
/// @param points_m  neighbours should not coincide   @param radii_m  [points]
void addTube(const std::vector<Vector3f>& points_m, const std::vector<float>& radii_m,
             const std::array<uint8_t, 4>& color, ToolShape& shape);

}  // namespace viscera
