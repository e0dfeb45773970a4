// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/steered_tool.h"

#include <cmath>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr size_t kMostDigits = 3;  ///< most digits of an axis number

double deflected(double value, double dead_zone) {
  if (!std::isfinite(value)) return 0;
  const double size = std::min(std::abs(value), 1.0);
  return size <= dead_zone ? 0 : std::copysign((size - dead_zone) / (1 - dead_zone), value);
}

}  // namespace

Pose approach(const Pose& from, const Pose& target, const SteeredSpeed& speed, double dt_s) {
  Pose out = target;
  const Vector3d offset = target.position_m - from.position_m;
  const double length = offset.norm(), most_m = speed.linear_m_per_s * dt_s;
  if (length > most_m) out.position_m = from.position_m + most_m / length * offset;
  const double angle = from.orientation.angularDistance(target.orientation), most_rad = speed.angular_rad_per_s * dt_s;
  if (angle > most_rad) out.orientation = from.orientation.slerp(most_rad / angle, target.orientation).normalized();
  return out;
}

Pose drive(const Pose& from, const Deflection& deflection, const SteeredSpeed& speed, double dt_s) {
  Pose out = from;
  out.position_m += speed.linear_m_per_s * dt_s * deflection.linear;
  const Vector3d turn = speed.angular_rad_per_s * dt_s * deflection.angular;
  const double angle = turn.norm();
  if (angle > 0) out.orientation = (Eigen::AngleAxisd(angle, turn / angle) * from.orientation).normalized();
  return out;
}

Pose within(const Pose& pose, const Vector3d& centre_m, double reach_m) {
  const Vector3d from_centre = pose.position_m - centre_m;
  const double distance = from_centre.norm();
  if (distance <= reach_m) return pose;
  return {centre_m + reach_m / distance * from_centre, pose.orientation};
}

AxisMap::AxisMap(const std::string& text) {
  TextIn words(text);
  size_t count = 0;
  bool good = true;
  for (std::string word; words >> word; ++count) {
    good = good && count < axes_.size();
    if (!good || word == "none") continue;
    const bool minus = word[0] == '-';
    const std::string digits = word.substr(minus || word[0] == '+' ? 1 : 0);
    good = good && !digits.empty() && digits.size() <= kMostDigits &&
           digits.find_first_not_of("0123456789") == std::string::npos;
    if (good) axes_[count] = Axis{std::stoul(digits), minus ? -1.0 : 1.0};
  }
  if (!good || count != axes_.size())
    throw Error(
        "six words, for x, y, z and rotations about them: each the number of an axis, with a minus to invert it, "
        "or none, as in '0 1 4 none none -3'; found '" +
        text + "'");
}

Deflection AxisMap::deflection(const std::vector<float>& axes, double dead_zone) const {
  Deflection out;
  for (size_t i = 0; i < axes_.size(); ++i) {
    if (!axes_[i] || axes_[i]->index >= axes.size()) continue;
    const double value = axes_[i]->sign * deflected(axes[axes_[i]->index], dead_zone);
    (i < 3 ? out.linear : out.angular)[static_cast<Eigen::Index>(i % 3)] = value;
  }
  return out;
}

bool AxisMap::fits(const std::vector<float>& axes) const {
  return std::all_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return !axis || axis->index < axes.size(); });
}

}  // namespace viscera
