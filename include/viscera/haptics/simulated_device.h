// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Parameters of an impedance-type device that a user holds: a mass with friction, coupled to the user's intended
/// position by a spring and a damper.
struct SimulatedDeviceConfig {
  double mass_kg = 0.1;                 ///< mass of the device's handle and of the hand that moves with it [kg]
  double damping_n_s_per_m = 0.2;       ///< damping of the device [N s/m]
  double hand_stiffness_n_per_m = 300;  ///< stiffness of the grip [N/m]; 0: the device is not held
  double hand_damping_n_s_per_m = 4;
  double tremor_m = 0;       ///< amplitude of physiological tremor, 8 to 12 Hz
  double delay_s = 0;        ///< delay from a pose to its force [s], half of it in each direction
  double encoder_m = 1e-5;   ///< resolution of the encoders [m]; 0: exact
  double period_s = 1e-3;    ///< period of its loop [s]
  double most_force_n = 20;  ///< largest force of its motors [N]
};

/// Simulates the device. A period is integrated in ten steps.
class VISCERA_PUBLIC SimulatedDevice {
 public:
  /// @param at_m  initial position of the device and of the user's intent
  SimulatedDevice(const SimulatedDeviceConfig& config, const Vector3d& at_m);

  /// Advances by one period. @param force_n  newest command   @param user_m  intended position at its end
  void step(const Vector3d& force_n, const Vector3d& user_m);
  /// Returns the encoders' position, delayed by half of the delay.
  const Vector3d& measured_m() const { return measured_[next_measured_]; }
  const Vector3d& position_m() const { return at_m_; }  ///< true position [m]
  const Vector3d& velocity_m_per_s() const { return velocity_; }
  const Vector3d& acting_n() const { return acting_n_; }  ///< current force of its motors [N]
  /// Returns the energy that the handle has given to the motors [J]; below 0, they were a source.
  double energy_j() const { return energy_j_; }

 private:
  Vector3d tremor() const;

  SimulatedDeviceConfig config_;
  Vector3d at_m_, user_m_, reported_m_, velocity_ = Vector3d::Zero(), acting_n_ = Vector3d::Zero();
  std::vector<Vector3d> measured_, commanded_;  ///< ring buffers of values in transit
  size_t next_measured_ = 0, next_commanded_ = 0;
  double energy_j_ = 0, time_s_ = 0;
};

}  // namespace viscera
