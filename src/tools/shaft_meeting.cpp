// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shaft_meeting.h"

#include <algorithm>

#include "math/archive.h"
#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

constexpr double kShaftStiffness_n_per_m = 500;  ///< below what the loop of a device renders stably (docs/haptics.md)
constexpr double kFarPast = 3;                   ///< of both radii: axes that are farther past each other have passed

struct Axis {
  Vector3d near, far;
  Vector3d at(double share) const { return near + share * (far - near); }
};

Axis axisOf(const StylusMotion& motion, const StylusConfig& config) {
  const double begin_m = std::min(motion.shaft_to_m, config.shaft_length_m);
  return {motion.to * Vector3d(0, 0, begin_m), motion.to * Vector3d(0, 0, config.shaft_length_m)};
}

double nearestShare(const Axis& axis, const Vector3d& x) {
  const Vector3d along = axis.far - axis.near;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? std::clamp((x - axis.near).dot(along) / length2, 0.0, 1.0) : 0;
}

/// Returns the points of two segments that are nearest to each other.
std::array<Vector3d, 2> nearestPoints(const Axis& a, const Axis& b) {
  const Vector3d u = a.far - a.near, v = b.far - b.near, off = b.near - a.near;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), parallel = uu * vv - uv * uv;
  constexpr double kParallel2 = 1e-9;  // sin^2 of the angle between the two
  double share = 0.5;
  if (parallel > kParallel2 * uu * vv) share = std::clamp((off.dot(u) * vv - off.dot(v) * uv) / parallel, 0.0, 1.0);
  const Vector3d on_b = b.at(nearestShare(b, a.at(share)));
  return {a.at(nearestShare(a, on_b)), on_b};
}

}  // namespace

void ShaftMeeting::advance(const ToolMotions& motions) {
  forces_ = {};
  if (!meets() || motions[0].shaft_to_m < 0 || motions[1].shaft_to_m < 0) return side_.reset();
  const auto [on_first, on_second] = nearestPoints(axisOf(motions[0], configs_[0]), axisOf(motions[1], configs_[1]));
  const Vector3d between = on_second - on_first;
  const double distance_m = between.norm(), radii_m = shaftRadius(configs_[0]) + shaftRadius(configs_[1]);
  Vector3d normal = distance_m > 0 ? Vector3d(between / distance_m) : side_.value_or(Vector3d::UnitZ());
  const bool past = side_ && normal.dot(*side_) < 0;
  if (past) normal = -normal;
  const double depth_m = radii_m - (past ? -distance_m : distance_m);
  if (depth_m <= 0 || (past && distance_m > kFarPast * radii_m)) return side_.reset();
  side_ = normal;
  const Vector3d force_n = kShaftStiffness_n_per_m * depth_m * normal;
  forces_[0] = {-force_n, (on_first - motions[0].to.position_m).cross(-force_n), false};
  forces_[1] = {force_n, (on_second - motions[1].to.position_m).cross(force_n), false};
}

void ShaftMeeting::addTo(size_t stylus, Reaction& reaction) const {
  reaction.force_n += forces_[stylus].force_n;
  reaction.torque_nm += forces_[stylus].torque_nm;
}

void ShaftMeeting::reset() {
  side_.reset();
  forces_ = {};
}

void ShaftMeeting::persist(Archive& archive) {
  if (!meets()) return;
  bool touches = side_.has_value();
  Vector3d side = side_.value_or(Vector3d::Zero());
  archive.value(touches);
  archive.value(side);
  side_ = touches ? std::optional(side) : std::nullopt;
}

}  // namespace viscera
