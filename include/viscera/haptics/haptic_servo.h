// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"
#include "viscera/haptics/contact_model.h"
#include "viscera/haptics/passivity.h"

namespace VISCERA_PUBLIC viscera {

struct HapticServoConfig {
  double period_s = 1e-3;    ///< period of the loop [s]
  double tick_s = 1.0 / 60;  ///< period of the simulation's ticks [s]
  double round_trip_s = 0;   ///< delay of the device [s]: from its measurement of a pose to the force that answers it,
                             ///< without our own delay
  double motion_scale = 1;   ///< metres of the tip per metre of the device, > 0
  double force_scale = 1;    ///< newtons of the device's motors per newton of the reaction
  TissueConstants tissue;
};

/// Force loop of one stylus at the device's rate (docs/haptics.md). It evaluates the tissue's local model at the
/// extrapolated position of the device, reduces the stiffness if the newest pose is too old for it, and keeps the loop
/// passive. Oscillations, energies and their thresholds are in the coordinates of the device: its metres, the newtons
/// of its motors.
class VISCERA_PUBLIC HapticServo {
 public:
  explicit HapticServo(const HapticServoConfig& config);

  /// Updates the local model with a tick.
  void put(const TickContact& contact, double now_s);
  /// Resets the loop if the stylus is not tracked or the simulation is paused. Forces go to zero within a tick.
  void clear(double now_s);
  /// Suspends the loop while no force is sent. Discards the motion of the device; the tissue model stays.
  void leave();
  /// Advances the loop by one period.
  /// @param tip_m   newest position of the tip, tissue frame
  /// @param pose_time_s  time of that position [s]; a device may be slower than the loop   @param now_s  never goes
  /// back
  /// @returns the desired reaction on the tip, before force_scale
  Reaction step(const Vector3d& tip_m, double pose_time_s, double now_s);
  /// Damps a force on the tip that has been limited since the last step(). @returns the force to send
  Vector3d damped(const Vector3d& limited_n, double now_s);
  /// Records the force that acts from now on, after every limit: force of the device's motors, axes of the tissue
  /// frame.
  void sent(const Vector3d& user_force_n, double now_s) { passivity_.sent(user_force_n, now_s); }

  const ContactModel& model() const { return model_; }
  const PassivityControl& passivity() const { return passivity_; }
  double stiffnessScale() const { return stiffness_scale_; }  ///< of fast motion: stiffness felt over the model's, 0..1
  double lead_s() const { return lead_s_; }  ///< time from a pose to its force for which the model extrapolates [s]

 private:
  void follow(const Vector3d& tip_m, double pose_time_s);
  void judge();
  double device_stiffness_n_per_m() const;
  double late_s() const;
  double owedRatio() const;
  double pokeRatio() const;
  Vector3d softened(const Vector3d& wanted_n);

  HapticServoConfig config_;
  ContactModel model_;
  PassivityControl passivity_;
  double lead_s_;
  bool placed_ = false;
  double pose_time_s_ = 0, between_poses_s_ = 0;
  // In the coordinates of the device.
  Vector3d at_m_ = Vector3d::Zero(), moved_m_ = Vector3d::Zero(), acting_n_ = Vector3d::Zero();
  Vector3d velocity_ = Vector3d::Zero(), acceleration_ = Vector3d::Zero(), mean_n_ = Vector3d::Zero();
  double stiffness_scale_ = 1, power_ = 0, speed2_ = 0, acceleration2_ = 0;
  // In the coordinates of the tip.
  Vector3d slow_n_ = Vector3d::Zero(), slower_n_ = Vector3d::Zero();
  ContactModel::Force last_;
  double stored_j_ = 0;  ///< energy stored in the tissue, at the device [J]
};

}  // namespace viscera
