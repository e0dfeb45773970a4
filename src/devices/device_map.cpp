// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_map.h"

namespace viscera {

DeviceMap::DeviceMap(const DeviceProfile& device)
    : unit_m_(device.pose.unit_m),
      scale_(device.scale),
      axes_(axesOf(device.pose.axes, "pose.axes")),
      turns_(axesOf(device.pose.turn_axes.empty() ? device.pose.axes : device.pose.turn_axes, "pose.turn_axes")),
      tip_(device.tip.pose()) {
  if (device.base.given) base_ = device.base.pose();
}

DeviceMap::TipPose DeviceMap::tipOf(const Pose& device_pose) const {
  const Pose stylus = Pose{axes_ * (unit_m_ * device_pose.position_m), turns_ * device_pose.orientation} * tip_;
  const Vector3d scaled_m = scale_ * stylus.position_m;
  if (clutched_ && last_m_) return {{*last_m_, stylus.orientation}, *last_m_ - scaled_m};
  return {{scaled_m + offset_m_, stylus.orientation}, offset_m_};
}

void DeviceMap::accept(const TipPose& tip_pose) {
  last_m_ = tip_pose.tip.position_m;
  offset_m_ = tip_pose.offset_m;
}

Pose DeviceMap::toBase(const Pose& device_pose) {
  const TipPose tip_pose = tipOf(device_pose);
  accept(tip_pose);
  return tip_pose.tip;
}

Pose DeviceMap::fromBase(const Pose& tip) const {
  const Pose stylus = Pose{(tip.position_m - offset_m_) / scale_, tip.orientation} * tip_.inverse();
  return {axes_.conjugate() * stylus.position_m / unit_m_, turns_.conjugate() * stylus.orientation};
}

}  // namespace viscera
