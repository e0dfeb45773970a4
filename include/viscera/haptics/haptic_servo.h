// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/haptics/contact_model.h"
#include "viscera/haptics/passivity.h"

namespace viscera {

struct HapticServoConfig {
  double period_s = 1e-3;    ///< of the loop
  double tick_s = 1.0 / 60;  ///< of the simulation
  double round_trip_s = 0;   ///< of the device: from a pose measured there to the force that answers it, without ours
  TissueConstants tissue;
};

/// The loop of one stylus at the device's rate: the tissue's local model at the newest pose, softened where that pose
/// is too old for its stiffness, and kept passive (docs/haptics.md).
class HapticServo {
 public:
  explicit HapticServo(const HapticServoConfig& config);

  /// What a tick found out.
  void put(const TickContact& contact, double now_s);
  /// The stylus is not tracked, or the tissue rests: forces go to nothing within a tick, and all begins anew.
  void forget(double now_s);
  /// One period.
  /// @param tip_m   newest place of the tip, tissue frame   @param told_s  when it was told: a device may be slower
  /// than the loop   @param now_s  never goes back
  Reaction step(const Vector3d& tip_m, double told_s, double now_s);
  /// What step() returned last was held back by limits: this was sent.
  void sent(const Vector3d& force_n) { passivity_.sent(force_n); }

  const ContactModel& model() const { return model_; }
  const PassivityControl& passivity() const { return passivity_; }
  double share() const { return share_; }    ///< of the model's stiffness that fast motion feels, 0..1
  double lead_s() const { return lead_s_; }  ///< how far ahead of a pose the model is asked [s]

 private:
  void follow(const Vector3d& tip_m, double told_s);
  void judge();
  Vector3d softened(const Vector3d& wanted_n);

  HapticServoConfig config_;
  ContactModel model_;
  PassivityControl passivity_;
  double lead_s_;
  bool placed_ = false;
  double told_s_ = 0;
  Vector3d tip_m_ = Vector3d::Zero(), moved_m_ = Vector3d::Zero();
  Vector3d velocity_ = Vector3d::Zero(), acceleration_ = Vector3d::Zero();
  Vector3d slow_n_ = Vector3d::Zero(), mean_n_ = Vector3d::Zero();
  double share_ = 1, power_ = 0, speed2_ = 0, acceleration2_ = 0;
  ContactModel::Force last_;
};

}  // namespace viscera
