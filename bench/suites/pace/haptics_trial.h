// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/haptics/haptic_servo.h"
#include "viscera/haptics/simulated_device.h"

namespace viscera::bench {

/// What befalls a held device, in contact. None lasts longer than 0.4 s.
enum class HapticEvent {
  kNone,
  kStall,   ///< no ticks for 150 ms, in which the hand goes 3 cm away
  kLeap,    ///< the device's base is put 15 mm higher, and back
  kClutch,  ///< the clutch is pressed, the hand goes 3 cm away, and comes back with it pressed
  kUnheard  ///< there is no listener to forces for 150 ms: the driver was started again
};
const char* nameOf(HapticEvent event);

/// What the device leads.
enum class HapticTool {
  kProbe,   ///< pressed into a block, held there
  kNeedle,  ///< pressed at a skin, driven through it, held inside, through the far one, and drawn back out
  kThread   ///< held in mode grab, pulled taut and more through channels
};

/// One cell of the matrix: a device in a hand presses a probe into a block of tissue, holds it there, and leaves.
struct HapticTrial {
  HapticTool tool = HapticTool::kProbe;
  double mass_kg = 0.1, delay_s = 0;
  double young_modulus_pa = 1e4;
  double rate_hz = 1000;   ///< of answers; 0: forces once per tick, as they come
  double poses_hz = 1000;  ///< of its driver
  HapticEvent event = HapticEvent::kNone;
};

/// What came of it.
struct HapticOutcome {
  double depth_mm = 0;               ///< of the tip below the surface while it is held
  double force_n = 0;                ///< of the servo, mean of the last part of the hold
  double simulator_n = 0;            ///< of the ticks, mean of the same
  double static_error = 0;           ///< between them, as a share
  double stiffness_n_per_m = 0;      ///< felt: what force and depth of two holds differ by
  double swing_n = 0, swing_mm = 0;  ///< half of peak to peak in the last part of the hold
  double least_energy_mj = 0;        ///< that the device's motors had taken in at any time; < 0: they gave
  double observed_mj = 0;            ///< the same as the observer has it
  /// What the force of a hold gives to a hand that leaves before the loop hears of it: force times speed times delay,
  /// from a pose to the force that answers it. No loop that gives the simulator's force to a hand at rest can keep it.
  double unheard_mj = 0;
  double free_n = 0;  ///< largest force before the first touch and after the last, the hand moving
  double share = 1;   ///< of the stiffness that fast motion feels, at the end
};

/// @throws what Session does
HapticOutcome runHapticTrial(const HapticTrial& trial);

/// A time of a trial that is looked at, with its name. Least energies and the force in free motion are of all of it.
struct HapticStage {
  const char* name;
  bool held;  ///< else it is of the largest forces of that time
  HapticOutcome outcome;
};
/// Of a needle or a thread; events befall neither.
std::vector<HapticStage> runSutureTrial(const HapticTrial& trial);

}  // namespace viscera::bench
