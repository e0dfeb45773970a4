// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// A device of impedance type in a hand: a mass with friction, which a hand leads along its way as a spring and a
/// damper do.
struct SimulatedDeviceConfig {
  double mass_kg = 0.1;                 ///< of the device's handle and what of the hand moves with it
  double damping_n_s_per_m = 0.2;       ///< of the device
  double hand_stiffness_n_per_m = 300;  ///< 0: it is not held
  double hand_damping_n_s_per_m = 4;
  double tremor_m = 0;       ///< amplitude of physiological tremor, 8 to 12 Hz
  double delay_s = 0;        ///< from a pose to the force that answers it, half on either way
  double encoder_m = 1e-5;   ///< places are told in whole steps of this; 0: exactly
  double period_s = 1e-3;    ///< of its loop
  double most_force_n = 20;  ///< its motors give no more
};

/// Steps such a device. Its motion between two periods is integrated in tenths of them.
class SimulatedDevice {
 public:
  /// @param at_m  where it is at first, and where the hand wants it
  SimulatedDevice(const SimulatedDeviceConfig& config, const Vector3d& at_m);

  /// A period. @param force_n  the newest command that was heard   @param hand_m  where the hand wants it at the end
  void step(const Vector3d& force_n, const Vector3d& hand_m);
  /// What its encoders said, half of the delay ago.
  const Vector3d& measured_m() const { return measured_[next_measured_]; }
  const Vector3d& position_m() const { return at_m_; }  ///< the true one
  const Vector3d& velocity_m_per_s() const { return velocity_; }
  const Vector3d& acting_n() const { return acting_n_; }  ///< force of its motors now
  /// Energy that the handle has given to the motors so far; below 0, they were a source.
  double energy_j() const { return energy_j_; }

 private:
  Vector3d tremor() const;

  SimulatedDeviceConfig config_;
  Vector3d at_m_, hand_m_, told_m_, velocity_ = Vector3d::Zero(), acting_n_ = Vector3d::Zero();
  std::vector<Vector3d> measured_, commanded_;  ///< under way, rings
  size_t next_measured_ = 0, next_commanded_ = 0;
  double energy_j_ = 0, time_s_ = 0;
};

}  // namespace viscera
