// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "haptics/wrench_schedule.h"
#include "viscera/haptics/haptic_servo.h"

namespace viscera {

/// Forces of all styluses, in ticks and between them: one HapticServo per stylus, evaluated at the newest poses at a
/// rate of its own, and the schedule that limits what is sent (docs/haptics.md). It has neither topics nor threads. The
/// owner calls next() when it is due, sends the result, and reports with sent() what reached the devices.
class ForceLoop {
 public:
  struct Stylus {
    ForceLimits limits;
    HapticServoConfig servo;
  };
  /// Results of a tick for a stylus.
  struct Tick {
    Reaction reaction;
    bool tracked = false;  ///< whether the stylus is tracked
    TickContact contact;
  };
  using Ticks = std::array<Tick, layout::kMaxStyluses>;
  /// Current input of a stylus.
  struct Input {
    bool tracked = false;        ///< whether it is tracked and moves the tool
    bool accepts_force = false;  ///< whether its device subscribes to forces
    Vector3d tip_m = Vector3d::Zero();
    SteadyTime pose_time{};  ///< arrival of its newest pose
    bool isActive() const { return tracked && accepts_force; }
  };
  using Inputs = std::array<Input, layout::kMaxStyluses>;
  /// Statistics of a stylus since the start, for the diagnostics. Energies are at the device.
  struct HapticStats {
    double energy_j = 0, least_j = 0;  ///< energy given by the user, from the passivity observer, and its minimum [J]
    double stiffness_scale = 1;        ///< share of the stiffness that acts on fast motion
    uint64_t updates = 0;              ///< number of evaluated periods
  };

  /// @param styluses  all with the same period   @param between_ticks  false: forces once per tick
  /// @param stall_s   longest time between two ticks that is not a stall [s]
  ForceLoop(const std::vector<Stylus>& styluses, bool between_ticks, double stall_s);

  bool betweenTicks() const { return between_ticks_; }
  void setLimits(size_t stylus, const ForceLimits& limits) { schedule_.setLimits(stylus, limits); }
  /// Updates the models with a tick. @param hands  in next()
  void put(const Ticks& ticks, const Inputs& inputs, SteadyTime now);
  /// Stops forces because there are no ticks. Everything is reset until the next one.
  void rest(SteadyTime now);
  /// Sends zero from now on.
  void release(SteadyTime now);
  /// Sends zero until resume(), regardless of ticks. resume() resets everything.
  void suspend(SteadyTime now);
  void resume(SteadyTime now);

  /// Returns the latest time for the next call of next().
  SteadyTime due() const;
  /// Returns the wrenches to send now, before a device's own scale and limits.
  Wrenches next(const Inputs& inputs, SteadyTime now);
  /// Records the forces that act from now on: forces of the motors, axes of the tissue frame; zero for a device that
  /// does not subscribe.
  void sent(const std::array<Vector3d, layout::kMaxStyluses>& device_forces_n, SteadyTime now);
  /// Returns whether periods are evaluated: ticks come in time, and some device subscribes.
  bool updating() const { return updating_; }

  const WrenchSchedule& schedule() const { return schedule_; }
  const HapticServo& servo(size_t stylus) const { return servos_[stylus]; }
  HapticStats stats(size_t stylus) const;

 private:
  double seconds(SteadyTime now) const { return std::chrono::duration<double>(now - SteadyTime{}).count(); }
  void update(const Inputs& inputs, SteadyTime now);
  void clear(SteadyTime now);
  void updateListeners(const Inputs& inputs, SteadyTime now);

  const bool between_ticks_;
  SteadyTime::duration period_{};
  WrenchSchedule schedule_;
  std::vector<HapticServo> servos_;  ///< [styluses]
  std::vector<uint64_t> updates_;
  SteadyTime period_due_{};
  bool updating_ = false;
};

}  // namespace viscera
