// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/plumb_bob.h"

#include <Eigen/LU>

namespace viscera {

namespace {

constexpr int kMostPlumbSteps = 50;   // steps of Newton's method, which needs about five
constexpr double kExact = 1e-13;      // for tangents of order 1: about a hundred rounding errors
constexpr double kFarthestBob = 1e3;  // tangent of a line of sight almost parallel to the image plane

/// Returns d distorted / d place.
Eigen::Matrix2d slopeOf(const PlumbBob& lens, const Eigen::Vector2d& position) {
  const double x = position.x(), y = position.y(), r2 = position.squaredNorm();
  const double radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
  const double by_r2 = lens.k1 + r2 * (2 * lens.k2 + r2 * 3 * lens.k3);
  Eigen::Matrix2d slope;
  slope(0, 0) = radial + 2 * x * x * by_r2 + 2 * lens.p1 * y + 6 * lens.p2 * x;
  slope(0, 1) = slope(1, 0) = 2 * x * y * by_r2 + 2 * lens.p1 * x + 2 * lens.p2 * y;
  slope(1, 1) = radial + 2 * y * y * by_r2 + 6 * lens.p1 * y + 2 * lens.p2 * x;
  return slope;
}

}  // namespace

Eigen::Vector2d distorted(const PlumbBob& lens, const Eigen::Vector2d& position) {
  const double x = position.x(), y = position.y(), r2 = position.squaredNorm();
  const double radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
  return {x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
          y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y};
}

std::optional<Eigen::Vector2d> undistorted(const PlumbBob& lens, const Eigen::Vector2d& position) {
  Eigen::Vector2d out = position;
  for (int step = 0; step < kMostPlumbSteps; ++step) {
    const Eigen::Vector2d off = distorted(lens, out) - position;
    const Eigen::Matrix2d slope = slopeOf(lens, out);
    if (!(slope.determinant() > 0 && slope.trace() > 0 && out.norm() < kFarthestBob)) return std::nullopt;
    if (off.norm() < kExact * (1 + position.norm())) return out;
    out -= slope.inverse() * off;
  }
  return std::nullopt;
}

}  // namespace viscera
