// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "haptics/wrench_schedule.h"
#include "viscera/haptics/haptic_servo.h"

namespace viscera {

/// Forces of all styluses, in ticks and between them: a HapticServo each, which newest poses ask at a rate of its own,
/// and the schedule that limits what goes out (docs/haptics.md). Knows neither topics nor threads: who owns it calls
/// next() when it is due, sends what it returns, and tells by sent() what hands got of it.
class ForceLoop {
 public:
  struct Stylus {
    ForceLimits limits;
    HapticServoConfig servo;
  };
  /// What a tick has for a stylus.
  struct Tick {
    Reaction reaction;
    bool tracked = false;  ///< a hand is there
    TickContact contact;
  };
  using Ticks = std::array<Tick, layout::kMaxStyluses>;
  /// A hand at this moment.
  struct Hand {
    bool tracked = false;  ///< and leads the tool
    bool listens = false;  ///< its device does
    Vector3d tip_m = Vector3d::Zero();
    SteadyTime told{};  ///< when its newest pose came
    bool feels() const { return tracked && listens; }
  };
  using Hands = std::array<Hand, layout::kMaxStyluses>;
  /// What a stylus felt since the start, for the diagnostics. Energies are the hand's.
  struct Felt {
    double energy_j = 0, least_j = 0;  ///< given by the hand, as the passivity observer has it
    double share = 1;                  ///< of the stiffness that fast motion feels
    uint64_t answers = 0;              ///< periods
  };

  /// @param styluses  all with one period   @param between_ticks  false: forces once per tick
  /// @param stall_s   a tick that comes later than this after the one before is a stall [s]
  ForceLoop(const std::vector<Stylus>& styluses, bool between_ticks, double stall_s);

  bool betweenTicks() const { return between_ticks_; }
  void setLimits(size_t stylus, const ForceLimits& limits) { schedule_.setLimits(stylus, limits); }
  /// A tick's answers. @param hands  as of next()
  void put(const Ticks& ticks, const Hands& hands, SteadyTime now);
  /// There are no ticks: all begins again with the next one.
  void rest(SteadyTime now);
  /// Zero for ever.
  void release(SteadyTime now);
  /// Zero until resume(), whatever ticks say; after it all begins again.
  void suspend(SteadyTime now);
  void resume(SteadyTime now);

  /// At the latest then next() is to be called.
  SteadyTime due() const;
  /// The wrenches to send now, before a device's own scale and limits.
  Wrenches next(const Hands& hands, SteadyTime now);
  /// What hands are told from now on: forces of their motors, axes of the tissue frame; nothing of a hand whose device
  /// does not listen.
  void sent(const std::array<Vector3d, layout::kMaxStyluses>& hand_forces_n, SteadyTime now);
  /// Periods are answered: ticks come in time, and some device listens.
  bool answering() const { return answering_; }

  const WrenchSchedule& schedule() const { return schedule_; }
  const HapticServo& servo(size_t stylus) const { return servos_[stylus]; }
  Felt felt(size_t stylus) const;

 private:
  double seconds(SteadyTime now) const { return std::chrono::duration<double>(now - SteadyTime{}).count(); }
  void answer(const Hands& hands, SteadyTime now);
  void forget(SteadyTime now);
  void heedListeners(const Hands& hands, SteadyTime now);

  const bool between_ticks_;
  SteadyTime::duration period_{};
  WrenchSchedule schedule_;
  std::vector<HapticServo> servos_;  ///< [styluses]
  std::vector<uint64_t> answers_;
  SteadyTime period_due_{};
  bool answering_ = false;
};

}  // namespace viscera
