// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/force_limiter.h"

namespace VISCERA_PUBLIC viscera {

/// Constraint of an instrument to a trocar: the axis of its shaft passes a fixed point. It maps poses of the device to
/// poses of the tool, and wrenches on the tool to wrenches at the device, so that both do the same work.
class VISCERA_PUBLIC Trocar {
 public:
  explicit Trocar(const StylusConfig& stylus);

  bool isPresent() const { return config_.follows != TrocarMotion::kNone; }
  /// Returns the pose of the tool for a pose of the device, both of the tip, tissue frame. The twist about the shaft
  /// stays. Without a trocar it is the same pose, as for a pose with an axis that passes the point.
  Pose toolPose(const Pose& device) const;
  /// Returns a pose with the same tip, turned by the least angle so that the axis of the shaft passes the point.
  Pose throughPoint(const Pose& tool) const;
  /// Returns the wrench that the device has to exert for a wrench on the tool. Follows the handle, at the distance r
  /// from the point: a force along the shaft stays, and one across it is multiplied by the lever 1 - length / r, which
  /// is below 0 while the tip is within the body; a torque T across the axis a adds the force T x a / r. Follows the
  /// tip: forces stay. The twist about the shaft neglects the angle between the shafts of device and tool.
  /// @param tool  force [N] and torque about the tip [N m], tissue frame   @param device  pose of the device
  Reaction deviceReaction(const Reaction& tool, const Pose& device) const;

 private:
  Vector3d directionTo(const Vector3d& to_m, const Vector3d& otherwise) const;
  Vector3d axisAtTip(const Pose& pose) const;
  /// Returns the length of the shaft from the point to the handle, at least a twentieth of the whole [m].
  double outside_m(const Vector3d& handle_m) const;

  TrocarConfig config_;
  double length_m_;
};

}  // namespace viscera
