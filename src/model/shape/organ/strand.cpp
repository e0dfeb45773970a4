// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/strand.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

constexpr int kPiecesPerSpan = 4;  ///< straight pieces between two knots

/// Returns a point of the Catmull-Rom curve between b and c. @tparam T  position or radius
template <class T>
T curvePoint(const T& a, const T& b, const T& c, const T& d, double t) {
  return 0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) + t * t * t * (3 * b - a - 3 * c + d));
}

}  // namespace

std::vector<Strand::Knot> curveThrough(const std::vector<Strand::Knot>& knots, int pieces) {
  using Knot = Strand::Knot;
  std::vector<Knot> out = {knots.front()};
  for (size_t i = 1; i < knots.size(); ++i) {
    const Knot &from = knots[i - 1], &to = knots[i];
    const Knot before = i > 1 ? knots[i - 2] : Knot{2 * from.at - to.at, from.radius};
    const Knot after = i + 1 < knots.size() ? knots[i + 1] : Knot{2 * to.at - from.at, to.radius};
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      out.push_back({curvePoint(before.at, from.at, to.at, after.at, t),
                     curvePoint(before.radius, from.radius, to.radius, after.radius, t)});
    }
  }
  return out;
}

Strand::Strand(const std::vector<Knot>& knots, double far) : points_(curveThrough(knots, kPiecesPerSpan)), far_(far) {
  for (const Knot& point : points_) {
    box_.extend(point.at - Vector3d::Constant(point.radius));
    box_.extend(point.at + Vector3d::Constant(point.radius));
  }
}

Strand::Nearest Strand::nearest(const Vector3d& p) const {
  Nearest found{std::numeric_limits<double>::infinity(), 0};
  if (points_.empty()) return found;
  const double beyond = box_.exteriorDistance(p);
  if (beyond > far_) return {beyond, points_.front().radius};
  for (size_t i = 1; i < points_.size(); ++i) {
    const Knot &a = points_[i - 1], &b = points_[i];
    const Vector3d piece = b.at - a.at;
    const double t = std::clamp((p - a.at).dot(piece) / std::max(piece.squaredNorm(), 1e-12), 0.0, 1.0);
    const double radius = a.radius + t * (b.radius - a.radius), distance = (p - a.at - t * piece).norm() - radius;
    if (distance < found.distance) found = {distance, radius};
  }
  return found;
}

}  // namespace viscera
