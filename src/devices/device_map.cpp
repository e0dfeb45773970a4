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

Pose DeviceMap::toBase(const Pose& device_pose) {
  const Pose hand = Pose{axes_ * (unit_m_ * device_pose.position_m), turns_ * device_pose.orientation} * tip_;
  const Vector3d scaled_m = scale_ * hand.position_m;
  if (clutched_) {
    if (!held_m_) held_m_ = last_m_ ? *last_m_ : Vector3d(scaled_m + offset_m_);
    offset_m_ = *held_m_ - scaled_m;
  }
  last_m_ = scaled_m + offset_m_;
  return {*last_m_, hand.orientation};
}

Pose DeviceMap::fromBase(const Pose& tip) const {
  const Pose hand = Pose{(tip.position_m - offset_m_) / scale_, tip.orientation} * tip_.inverse();
  return {axes_.conjugate() * hand.position_m / unit_m_, turns_.conjugate() * hand.orientation};
}

void DeviceMap::setClutch(bool pressed) {
  clutched_ = pressed;
  held_m_.reset();
}

}  // namespace viscera
