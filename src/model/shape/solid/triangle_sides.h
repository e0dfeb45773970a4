// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace viscera {

/// One side of a triangle; `forward` where the triangle runs from the lower to the higher vertex.
struct Side {
  uint32_t low, high;
  uint32_t triangle;
  bool forward;

  bool sameEdge(const Side& other) const { return low == other.low && high == other.high; }
};

/// Returns the sides of triangles, with those of one edge next to each other.
inline std::vector<Side> sortedSides(const std::vector<std::array<uint32_t, 3>>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

/// Calls visit(first, last) for the sides of every edge.
template <typename Visit>
void forEachEdge(const std::vector<Side>& sides, Visit visit) {
  for (size_t first = 0; first < sides.size();) {
    size_t last = first + 1;
    while (last < sides.size() && sides[last].sameEdge(sides[first])) ++last;
    visit(first, last);
    first = last;
  }
}

}  // namespace viscera
