// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/layout/types.h"
#include "viscera/surface/skin_marks.h"

namespace viscera {

/// Straight pieces of marks at rest, and for each cell of a grid those that may be drawn in it: shaders/draw/marks.glsl
/// reads both.
struct MarkGrid {
  /// Three texels per segment: xyz from [m], w distance along the line there [m]; xyz to [m], w half of the width [m];
  /// mark, bits of patterns, body, 1: solid where the pattern is crossed.
  std::vector<layout::vec4> segments;
  std::vector<uint32_t> cells;  ///< first index << 8 | count of each cell, x fastest; then the indices of segments
  Vector3f corner_m = Vector3f::Zero();
  float cell_m = 1;
  std::array<uint32_t, 3> counts{};
};

/// @param strokes  of all marks   A cell takes 255 segments, and leaves out others
MarkGrid gridOf(const std::vector<MarkStroke>& strokes);

}  // namespace viscera
