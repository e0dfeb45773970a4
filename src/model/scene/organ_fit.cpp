// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/organ_fit.h"

#include "math/number_text.h"

namespace viscera {
namespace {

/// Range of the largest stretch: an organ of 0.1 m becomes one of 2 mm to 2 m.
constexpr double kLeastStretch = 1.0 / 50, kMostStretch = 20;
constexpr double kThinnest = 1e-3;  ///< limit of the smallest stretch: a plate
/// Margin of the image: an organ that fills its box needs more of it than one with empty corners, such as a heart.
constexpr double kRoom = 1.15;

std::string sizeText(const Eigen::AlignedBox3d& box_m) {
  const Vector3d size_m = box_m.sizes();
  TextOut out;
  out.precision(3);
  out << size_m.x() << " x " << size_m.y() << " x " << size_m.z() << " m";
  return out.str();
}

}  // namespace

OrganFit OrganFit::between(const Eigen::AlignedBox3d& from_m, const Eigen::AlignedBox3d& to_m, const Vector3d& sight) {
  OrganFit fit;
  fit.from_m = from_m;
  fit.to_m = to_m;
  fit.stretch = to_m.sizes().cwiseQuotient(from_m.sizes());
  fit.view_scale = kRoom * fit.stretch.maxCoeff();
  Eigen::Index depth = 0;
  sight.cwiseAbs().maxCoeff(&depth);
  fit.tool_scale = std::min(fit.stretch[(depth + 1) % 3], fit.stretch[(depth + 2) % 3]);
  return fit;
}

Vector3d OrganFit::moved(const Vector3d& point_m) const {
  return to_m.center() + stretch.cwiseProduct(point_m - from_m.center());
}

Vector3d OrganFit::viewed(const Vector3d& point_m) const {
  return to_m.center() + view_scale * (point_m - from_m.center());
}

bool OrganFit::isSound() const {
  const double most = stretch.maxCoeff();
  return stretch.minCoeff() >= kThinnest && most >= kLeastStretch && most <= kMostStretch;  // false for NaN
}

std::string OrganFit::text() const {
  TextOut out;
  out.precision(3);
  out << "scene fitted to the organ's box, " << sizeText(to_m) << ", from its own, " << sizeText(from_m)
      << ": cameras scaled by " << view_scale << ", tools and strokes by " << tool_scale
      << ", fixed regions, obstacles and anchors moved from box to box; keys that an override sets keep their values";
  return out.str();
}

}  // namespace viscera
