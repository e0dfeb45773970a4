// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "viscera/math/types.h"

namespace viscera {

// Building blocks of phantoms: (nearly) signed distances, negative inside. Lengths are in any one unit.

/// Smaller of two distances, blended over a width k where they are close.
inline double smoothMin(double a, double b, double k) {
  if (k <= 0) return std::min(a, b);
  const double overlap = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - overlap * overlap * k / 4;
}
inline double smoothMax(double a, double b, double k) {
  return -smoothMin(-a, -b, k);
}

/// Ellipsoid with axes along x, y, z. The distance is exact on the surface and to first order near it.
struct Ellipsoid {
  Vector3d center, radii;

  double distance(const Vector3d& p) const {
    const Vector3d scaled = (p - center).cwiseQuotient(radii);
    const double level = scaled.norm(), slope = scaled.cwiseQuotient(radii).norm();
    if (slope == 0) return -radii.minCoeff();
    return level * (level - 1) / slope;
  }
};

/// Straight tube between two points with flat ends.
struct Tube {
  Vector3d from, to;
  double radius;

  double distance(const Vector3d& p) const {
    const Vector3d axis = (to - from).normalized();
    const double along = (p - from).dot(axis), aside = (p - from - along * axis).norm();
    return std::max(aside - radius, std::max(-along, along - (to - from).norm()));
  }
};

}  // namespace viscera
