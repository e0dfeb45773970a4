// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_shape.h"

#include <algorithm>
#include <cmath>

#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kSuturePi = 3.14159265358979323846;

struct Preset {
  double young_modulus_pa, density_kg_per_m3, bending_share;
};

/// Returns the values of docs/sutures.md, Material and size.
Preset presetOf(SutureMaterial material) {
  switch (material) {
    case SutureMaterial::kSilk:
      return {8.7e9, 1300, 0.05};
    case SutureMaterial::kNylon:
      return {2.5e9, 1140, 1};
    default:
      return {3.0e9, 910, 1};
  }
}

/// Returns half of the middle of the size's range of average diameters [m].
double radiusOf_m(SutureSize size) {
  constexpr double kDiameters_mm[] = {0.32, 0.225, 0.175, 0.125, 0.085};
  return 0.5e-3 * kDiameters_mm[static_cast<size_t>(size)];
}

double orElse(double value, double otherwise) {
  return value > 0 ? value : otherwise;
}

/// Walks along a path in straight steps of one length; beyond its end the path continues straight.
class Walk {
 public:
  explicit Walk(const SutureConfig& config) : path_{config.position_m}, at_(config.position_m) {
    for (const SuturePathPoint& position : config.path) {
      if (position.position_m != path_.back()) path_.push_back(position.position_m);
    }
    if (path_.size() < 2)
      throw SceneError("suture '" + config.name + "': 'path' must contain a position that differs from 'position_m'");
  }
  double length_m() const {
    double out = 0;
    for (size_t i = 1; i < path_.size(); ++i) out += (path_[i] - path_[i - 1]).norm();
    return out;
  }
  const Vector3d& at() const { return at_; }
  void go(double distance_m) {
    for (;; ++next_) {
      const Vector3d& from = path_[next_ - 1];
      const Vector3d offset = path_[next_] - from;
      const double length2 = offset.squaredNorm(), near = offset.dot(at_ - from) / length2;
      const double off2 = (from + near * offset - at_).squaredNorm();
      const double share = near + std::sqrt(std::max(0.0, distance_m * distance_m - off2) / length2);
      if (share > 1 && next_ + 1 < path_.size()) continue;
      at_ = from + share * offset;
      return;
    }
  }

 private:
  std::vector<Vector3d> path_;  ///< without repeated points
  Vector3d at_;
  size_t next_ = 1;  ///< end of the current segment
};

}  // namespace

ChainMaterial materialOf(const SutureConfig& config) {
  const Preset preset = presetOf(config.material);
  ChainMaterial out;
  out.radius_m = orElse(config.radius_m, radiusOf_m(config.usp));
  out.density_kg_per_m3 = orElse(config.density_kg_per_m3, preset.density_kg_per_m3);
  out.bending_nm2 = orElse(config.bending_share, preset.bending_share) *
                    orElse(config.young_modulus_pa, preset.young_modulus_pa) * kSuturePi * std::pow(out.radius_m, 4) /
                    4;
  out.mass_damping_per_s = config.mass_damping_per_s;
  return out;
}

std::vector<Vector3d> positionsOf(const SutureConfig& config) {
  Walk walk(config);
  const double length_m = orElse(config.length_m, walk.length_m());
  const int links = static_cast<int>(std::lround(length_m / config.spacing_m));
  std::vector<Vector3d> out = {walk.at()};
  for (int i = 0; i < std::max(links, 2); ++i) {
    walk.go(config.spacing_m);
    out.push_back(walk.at());
  }
  return out;
}

}  // namespace viscera
