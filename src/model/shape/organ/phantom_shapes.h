// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "viscera/math/types.h"

namespace viscera {

// Building blocks of phantoms: (nearly) signed distances, negative inside. All lengths are in one arbitrary unit.

/// Returns the smaller of two distances, blended over a width k where they are close.
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
class Tube {
 public:
  Tube() = default;
  Tube(const Vector3d& from, const Vector3d& to, double radius)
      : from_(from), to_(to), axis_((to - from).normalized()), length_((to - from).norm()), radius_(radius) {}

  const Vector3d& from() const { return from_; }
  const Vector3d& to() const { return to_; }
  const Vector3d& axis() const { return axis_; }
  double radius() const { return radius_; }

  /// Returns the distance to the tube with a radius larger by `margin`.
  double distance(const Vector3d& p, double margin = 0) const {
    const double along = (p - from_).dot(axis_), aside = (p - from_ - along * axis_).norm();
    return std::max(aside - (radius_ + margin), std::max(-along, along - length_));
  }

 private:
  Vector3d from_ = Vector3d::Zero(), to_ = Vector3d::Zero(), axis_ = Vector3d::Zero();
  double length_ = 0, radius_ = 0;
};

}  // namespace viscera
