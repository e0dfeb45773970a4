// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/needle_shape.h"

#include <algorithm>
#include <cmath>

#include "solver/processes/suture/suture_contacts.h"

namespace viscera {

namespace {

constexpr double kFullTurn = 2 * 3.14159265358979323846;
constexpr double kSteel_kg_per_m3 = 7900;
constexpr double kProbed = 4;         // in wire radii: distance of the points that may touch obstacles
constexpr int kMostNeedleSteps = 16;  // per substep: the rest of a longer motion follows in later ones
constexpr int kOuts = 8;              // corrections of a step, each by the deepest point
constexpr double kInObstacle = 0.1;   // in wire radii: a step with a larger remaining depth is rejected

/// Returns the shortest displacement that moves the deepest point out of its obstacle [m].
Vector3d exit_m(const NeedleShape& shape, const Pose& pose, const layout::ObstacleMotion* obstacles, uint32_t count) {
  Vector3d out = Vector3d::Zero();
  double deepest_m = 0;
  const auto probes = static_cast<size_t>(2 + shape.length_m() / (kProbed * shape.wireRadius_m()));
  for (const Vector3d& position : shape.positions(pose, probes)) {
    for (uint32_t o = 0; o < count; ++o) {
      const ObstacleSide side = sideOf(obstacles[o], position);
      const double depth_m = shape.wireRadius_m() - side.distance_m;
      if (depth_m <= deepest_m) continue;
      deepest_m = depth_m;
      out = depth_m * side.normal;
    }
  }
  return out;
}

}  // namespace

NeedleShape::NeedleShape(const NeedleConfig& config)
    : NeedleShape(config.radius_m, config.arc == NeedleArc::kThreeEighths ? 0.375 * kFullTurn : 0.5 * kFullTurn,
                  config.wire_radius_m) {}

Vector3d NeedleShape::at(double behind_m) const {
  const double angle = -behind_m / radius_m_;
  return {radius_m_ * std::cos(angle), 0, radius_m_ * std::sin(angle)};
}

Vector3d NeedleShape::forward(double behind_m) const {
  const double angle = -behind_m / radius_m_;
  return {-std::sin(angle), 0, std::cos(angle)};
}

double NeedleShape::nearest_m(const Vector3d& own_m) const {
  const double middle = 0.5 * angle_rad_;
  return radius_m_ * (middle + std::remainder(-std::atan2(own_m.z(), own_m.x()) - middle, kFullTurn));
}

Vector3d NeedleShape::middle() const {
  const double half = 0.5 * angle_rad_;
  return std::sin(half) / half * at(0.5 * length_m());
}

double NeedleShape::mass_kg() const {
  return kSteel_kg_per_m3 * 0.5 * kFullTurn * wire_radius_m_ * wire_radius_m_ * length_m();
}

Pose NeedleShape::withTailAt(const Vector3d& tail_m, const Quaterniond& orientation) const {
  return {tail_m - orientation * at(length_m()), orientation};
}

std::vector<Vector3d> NeedleShape::positions(const Pose& pose, size_t count) const {
  std::vector<Vector3d> out;
  for (size_t i = 0; i < count; ++i)
    out.push_back(pose * at(length_m() * static_cast<double>(i) / static_cast<double>(count - 1)));
  return out;
}

Pose keptOut(const NeedleShape& shape, const Pose& from, const Pose& to, const layout::ObstacleMotion* obstacles,
             uint32_t count) {
  if (count == 0) return to;
  const double turn = from.orientation.angularDistance(to.orientation);
  const double offset_m = (to.position_m - from.position_m).norm() + 2 * turn * shape.radius_m();
  const int steps = std::max(1, static_cast<int>(std::ceil(offset_m / shape.wireRadius_m())));
  Pose at = from;
  for (int i = 1; i <= std::min(steps, kMostNeedleSteps); ++i) {
    const Pose before = at;
    at = interpolate(at, to, 1.0 / (steps - i + 1));
    Vector3d out = exit_m(shape, at, obstacles, count);
    for (int k = 0; k < kOuts && !out.isZero(0); ++k) {
      at.position_m += out;
      out = exit_m(shape, at, obstacles, count);
    }
    if (out.norm() > kInObstacle * shape.wireRadius_m()) return before;
  }
  return at;
}

}  // namespace viscera
