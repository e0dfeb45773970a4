// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/haptics/haptic_servo.h"
#include "viscera/haptics/simulated_device.h"

namespace viscera::bench {

/// An event during contact with a held device. None but the pokes lasts longer than 0.4 s.
enum class HapticEvent {
  kNone,
  kStall,   ///< no ticks for 150 ms, in which the user moves 3 cm away
  kLeap,    ///< the device's base is moved up by 15 mm, and back
  kClutch,  ///< the clutch is pressed while the user moves 3 cm away and back
  kPokes,   ///< eight pokes of 9 mm at 0.12 m/s before the holds
  kUnheard  ///< no subscriber to forces for 150 ms: the driver was restarted
};
const char* nameOf(HapticEvent event);

/// The tool that the device moves.
enum class HapticTool {
  kProbe,   ///< pressed into a block and held there
  kNeedle,  ///< pressed at a surface, driven through it, held inside, driven through the far one, retracted
  kSuture   ///< held in mode grab, pulled taut, and further through channels
};

/// One cell of the matrix: a held device presses a probe into a block of tissue, holds it there, and retracts it.
struct HapticTrial {
  HapticTool tool = HapticTool::kProbe;
  double mass_kg = 0.1, delay_s = 0;
  double young_modulus_pa = 1e4;
  double rate_hz = 1000;   ///< rate of forces [Hz]; 0: forces once per tick, as they come
  double poses_hz = 1000;  ///< rate of its driver [Hz]
  HapticEvent event = HapticEvent::kNone;
};

/// The result of a trial.
struct HapticOutcome {
  double depth_mm = 0;               ///< depth of the tip below the surface while held [mm]
  double force_n = 0;                ///< force of the servo, mean of the last part of the hold [N]
  double simulator_n = 0;            ///< force of the ticks, mean likewise [N]
  double static_error = 0;           ///< relative difference of the two
  double stiffness_n_per_m = 0;      ///< stiffness at the device [N/m], from two holds
  double swing_n = 0, swing_mm = 0;  ///< half of peak to peak in the last part of the hold
  double least_energy_mj = 0;        ///< least energy absorbed by the motors so far [mJ]; < 0: delivered
  double observed_mj = 0;            ///< same by the observer [mJ]
  /// Energy that the force of a hold, or of one poke, gives to a user who retracts before the loop receives it: force
  /// times speed times delay, from a pose to the force that answers it [mJ]. No loop that renders the simulator's force
  /// to a user at rest can avoid it.
  double unheard_mj = 0;
  double free_n = 0;           ///< largest force before the first contact and after the last, with the user moving [N]
  double stiffness_scale = 1;  ///< share of the stiffness that acts on fast motion, at the end
};

/// Runs a trial. @throws as Session does
HapticOutcome runHapticTrial(const HapticTrial& trial);

/// A time span of a trial that is evaluated, with its name. Least energies and the force in free motion are of the
/// whole trial.
struct HapticStage {
  const char* name;
  bool held;  ///< whether the tool is held; otherwise the outcome has the largest forces of the span
  HapticOutcome outcome;
};
/// Runs a trial of a needle or a suture, without events.
std::vector<HapticStage> runSutureTrial(const HapticTrial& trial);

}  // namespace viscera::bench
