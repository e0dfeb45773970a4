// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/trocar.h"

#include <algorithm>

namespace viscera {
namespace {

/// Least length of a shaft outside the body, over its whole length: closer to the point a handle would rotate the
/// shaft by any angle.
constexpr double kLeastOutside = 0.05;
constexpr double kSamePoint_m = 1e-9;

Vector3d across(const Vector3d& v, const Vector3d& axis) {
  return v - axis * axis.dot(v);
}
Vector3d shaftOf(const Pose& pose) {
  return pose.orientation * Vector3d::UnitZ();
}
Quaterniond turned(const Quaterniond& orientation, const Vector3d& axis) {
  return (Quaterniond::FromTwoVectors(orientation * Vector3d::UnitZ(), axis) * orientation).normalized();
}

}  // namespace

Trocar::Trocar(const StylusConfig& stylus) : config_(stylus.trocar), length_m_(stylus.shaft_length_m) {}

/// Returns the direction from the point to `to_m`, or `otherwise` where both are the same.
Vector3d Trocar::directionTo(const Vector3d& to_m, const Vector3d& otherwise) const {
  const Vector3d out = to_m - config_.position_m;
  return out.norm() > kSamePoint_m ? Vector3d(out.normalized()) : otherwise;
}

/// Returns the axis of the tool from its tip to its handle. A tip that was pulled out is on the handle's side.
Vector3d Trocar::axisAtTip(const Pose& pose) const {
  const Vector3d shaft = shaftOf(pose), away = directionTo(pose.position_m, shaft);
  return away.dot(shaft) > 0 ? away : Vector3d(-away);
}

double Trocar::outside_m(const Vector3d& handle_m) const {
  return std::max((handle_m - config_.position_m).norm(), kLeastOutside * length_m_);
}

Pose Trocar::toolPose(const Pose& device) const {
  if (config_.follows != TrocarMotion::kHandle) return throughPoint(device);
  const Vector3d shaft = shaftOf(device), handle_m = device.position_m + length_m_ * shaft;
  const Vector3d axis = directionTo(handle_m, shaft);
  return {config_.position_m + (outside_m(handle_m) - length_m_) * axis, turned(device.orientation, axis)};
}

Pose Trocar::throughPoint(const Pose& tool) const {
  if (!isPresent()) return tool;
  return {tool.position_m, turned(tool.orientation, axisAtTip(tool))};
}

Reaction Trocar::deviceReaction(const Reaction& tool, const Pose& device) const {
  if (!isPresent()) return tool;
  const Vector3d shaft = shaftOf(device);
  Reaction out = tool;
  if (config_.follows == TrocarMotion::kTip) {
    const Vector3d axis = axisAtTip(device), to_point = config_.position_m - device.position_m;
    // The axis turns by -(tip's motion across it) / (signed distance of the point along it).
    const double along_m = to_point.dot(axis);
    if (std::abs(along_m) > kLeastOutside * length_m_) out.force_n -= tool.torque_nm.cross(axis) / along_m;
    out.torque_nm = shaft * axis.dot(tool.torque_nm);
    return out;
  }
  const Vector3d handle_m = device.position_m + length_m_ * shaft, axis = directionTo(handle_m, shaft);
  const double r_m = outside_m(handle_m), lever = 1 - length_m_ / r_m;
  const Vector3d lateral_n = across(tool.force_n, axis);
  out.force_n = tool.force_n - lateral_n + lever * lateral_n + tool.torque_nm.cross(axis) / r_m;
  out.torque_nm = length_m_ * shaft.cross(out.force_n) + shaft * axis.dot(tool.torque_nm);
  return out;
}

}  // namespace viscera
