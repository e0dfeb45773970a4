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
  double motion_scale = 1;   ///< metres of the tip per metre of the hand, > 0
  double force_scale = 1;    ///< newtons of the device's motors per newton of the reaction
  TissueConstants tissue;
};

/// The loop of one stylus at the device's rate: the tissue's local model where the hand is by now, softened where the
/// newest pose is too old for its stiffness, and kept passive (docs/haptics.md). Swings, energies and their thresholds
/// are the hand's: its metres, the newtons of its motors.
class HapticServo {
 public:
  explicit HapticServo(const HapticServoConfig& config);

  /// What a tick found out.
  void put(const TickContact& contact, double now_s);
  /// The stylus is not tracked, or the tissue rests: forces go to nothing within a tick, and all begins again.
  void forget(double now_s);
  /// No force is sent for a while: what was known of the hand is void, the tissue's model stays.
  void leave();
  /// One period.
  /// @param tip_m   newest place of the tip, tissue frame   @param told_s  when it was told: a device may be slower
  /// than the loop   @param now_s  never goes back
  /// @returns the reaction on the tip that is wanted, before force_scale
  Reaction step(const Vector3d& tip_m, double told_s, double now_s);
  /// What of a force on the tip may go out, limited as it is by now, since the last step().
  Vector3d damped(const Vector3d& limited_n, double now_s);
  /// What the hand is told from now on, after every limit: force of the device's motors, axes of the tissue frame.
  void sent(const Vector3d& hand_force_n, double now_s) { passivity_.sent(hand_force_n, now_s); }

  const ContactModel& model() const { return model_; }
  const PassivityControl& passivity() const { return passivity_; }
  double share() const { return share_; }    ///< of the model's stiffness that fast motion feels, 0..1
  double lead_s() const { return lead_s_; }  ///< how far ahead of a pose the model is asked [s]

 private:
  void follow(const Vector3d& tip_m, double told_s);
  void judge();
  double felt_n_per_m() const;
  double late_s() const;
  Vector3d softened(const Vector3d& wanted_n);

  HapticServoConfig config_;
  ContactModel model_;
  PassivityControl passivity_;
  double lead_s_;
  bool placed_ = false;
  double told_s_ = 0, between_poses_s_ = 0;
  // Of the hand.
  Vector3d at_m_ = Vector3d::Zero(), moved_m_ = Vector3d::Zero(), acting_n_ = Vector3d::Zero();
  Vector3d velocity_ = Vector3d::Zero(), acceleration_ = Vector3d::Zero(), mean_n_ = Vector3d::Zero();
  double share_ = 1, power_ = 0, speed2_ = 0, acceleration2_ = 0;
  // Of the tip.
  Vector3d slow_n_ = Vector3d::Zero(), slower_n_ = Vector3d::Zero();
  ContactModel::Force last_;
  double stored_j_ = 0;  ///< as the hand feels it
};

}  // namespace viscera
