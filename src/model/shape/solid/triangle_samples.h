// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "viscera/math/types.h"

namespace viscera {

/// Calls visit(point) for points of a triangle that are at most a quarter of a cell apart.
/// @param corners  in cells
template <class Visit>
void forEachSample(const std::array<Vector3d, 3>& corners, Visit visit) {
  constexpr double kBetween = 0.25;  // in cells
  const auto& [p, q, r] = corners;
  const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / kBetween)));
  for (int a = 0; a <= steps; ++a) {
    for (int b = 0; a + b <= steps; ++b) visit(Vector3d(p + (a * (q - p) + b * (r - p)) / steps));
  }
}

}  // namespace viscera
