// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "devices/device_profile.h"

namespace viscera {

/// From what a device says to where the tool's tip is, and back: units, axes, tip, scale, clutch (docs/devices.md).
///
/// A pose (p, q) of the device becomes (s (A u p + B q r) + o, B q R) in the frame of its base: u metres per unit, A
/// and B the rotations of `axes` and `turn_axes`, (r, R) the tip, s the scale, and o what clutching has added.
class DeviceMap {
 public:
  explicit DeviceMap(const DeviceProfile& device);

  /// What a pose of the device says, before it is known to be a good one.
  struct Place {
    Pose tip;                              ///< in the frame of the device's base
    Vector3d offset_m = Vector3d::Zero();  ///< what clutching has added by then
  };
  /// While the clutch is pressed the tip stays where it was when a pose was accepted last, and turns.
  Place placeOf(const Pose& device_pose) const;
  /// The tool is there: from there a clutch goes on.
  void accept(const Place& place);
  /// The tip at a pose that is good: placeOf() and accept().
  Pose toBase(const Pose& device_pose);
  /// The device's pose that toBase() takes to this one.
  Pose fromBase(const Pose& tip) const;
  /// The hand moves and the tool does not from now on, or follows it again.
  void setClutch(bool pressed) { clutched_ = pressed; }
  bool clutched() const { return clutched_; }
  /// The place of the base in the tissue frame, where the profile knows it.
  const std::optional<Pose>& base() const { return base_; }
  /// Turns a vector of the base's frame into the device's own axes.
  Quaterniond axesFromBase() const { return axes_.conjugate(); }
  /// From the origin of a device's pose to the tip [m], in the frame of the base.
  Vector3d leverArm(const Pose& device_pose) const { return (turns_ * device_pose.orientation) * tip_.position_m; }

 private:
  double unit_m_, scale_;
  Quaterniond axes_, turns_;
  Pose tip_;
  std::optional<Pose> base_;
  Vector3d offset_m_ = Vector3d::Zero();  ///< what clutching has added
  bool clutched_ = false;
  std::optional<Vector3d> last_m_;  ///< where the tip was last
};

}  // namespace viscera
