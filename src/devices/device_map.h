// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "devices/device_profile.h"

namespace viscera {

/// Maps the pose of a device to that of the tool's tip, and back: units, axes, tip, scale, clutch (docs/devices.md).
///
/// A pose (p, q) of the device becomes (s (A u p + B q r) + o, B q R) in the frame of its base: u metres per unit, A
/// and B the rotations of `axes` and `turn_axes`, (r, R) the tip, s the scale, and o the offset of the clutch.
class DeviceMap {
 public:
  explicit DeviceMap(const DeviceProfile& device);

  /// Result for a pose of the device that is not yet accepted.
  struct TipPose {
    Pose tip;                              ///< pose of the tip in the frame of the device's base
    Vector3d offset_m = Vector3d::Zero();  ///< offset of the clutch at this pose [m]
  };
  /// Maps a pose. While the clutch is pressed, the tip keeps its last accepted position and only rotates.
  TipPose tipOf(const Pose& device_pose) const;
  /// Accepts a result; the clutch continues from its position.
  void accept(const TipPose& tip_pose);
  /// Maps and accepts a pose: tipOf() and accept().
  Pose toBase(const Pose& device_pose);
  /// Returns the device's pose that toBase() maps to this one.
  Pose fromBase(const Pose& tip) const;
  /// Sets the clutch: while it is pressed, the device moves and the tool does not.
  void setClutch(bool pressed) { clutched_ = pressed; }
  bool clutched() const { return clutched_; }
  /// Returns the pose of the base in the tissue frame, if the profile has it.
  const std::optional<Pose>& base() const { return base_; }
  /// Returns the rotation from the base's frame to the device's own axes.
  Quaterniond axesFromBase() const { return axes_.conjugate(); }
  /// Returns the vector from the origin of a device's pose to the tip [m], in the frame of the base.
  Vector3d leverArm(const Pose& device_pose) const { return (turns_ * device_pose.orientation) * tip_.position_m; }

 private:
  double unit_m_, scale_;
  Quaterniond axes_, turns_;
  Pose tip_;
  std::optional<Pose> base_;
  Vector3d offset_m_ = Vector3d::Zero();  ///< offset of the clutch [m]
  bool clutched_ = false;
  std::optional<Vector3d> last_m_;  ///< last accepted position of the tip [m]
};

}  // namespace viscera
