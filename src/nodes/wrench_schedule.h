// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/math/types.h"
#include "viscera/tools/force_limiter.h"

namespace viscera::nodes {

using Wrenches = std::array<Reaction, layout::kMaxStyluses>;

/// What devices are told, and when: the simulation's answers, limited in size and slew in wall-clock time; nothing
/// where they are late, rest or have ended. Knows neither ROS nor threads; times are the caller's, and never go back.
class WrenchSchedule {
 public:
  using Time = SteadyTime;
  /// How a force goes away in an ordered end or a stall, however slow the slew that its device is used to.
  static constexpr double kRelease_s = 0.01;
  /// Between two messages while a limit holds a wrench back: fine enough that a device feels a ramp.
  static constexpr double kSlewPeriod_s = 0.002;
  /// Between two messages of zero while nothing else is to be said, for a device that comes late.
  static constexpr double kIdlePeriod_s = 0.02;
  /// Ticks in time, one after the other, that end a stall: a simulation that is always late gives no forces.
  static constexpr int kTicksInTime = 3;

  /// @param limits   [styluses]
  /// @param stall_s  a tick that comes later than this after the one before is a stall [s]
  WrenchSchedule(const std::vector<ForceLimits>& limits, double stall_s);

  /// Of a stylus, from the next() on: what is above them goes down by their slew.
  void setLimits(size_t stylus, const ForceLimits& limits);
  /// A tick's answer.
  void put(const Wrenches& wanted, Time now);
  /// What is wanted at this moment between two ticks; heeded only while ticks come in time.
  void follow(const Wrenches& wanted);
  bool live() const { return mode_ == Mode::kLive; }
  /// There are no ticks, and no forces, until the next put(): paused, or not begun.
  void rest(Time now);
  /// Zero for ever.
  void release(Time now);
  /// At the latest then next() is to be called, whatever has come.
  Time due() const;
  /// The wrenches to send now.
  Wrenches next(Time now);

  bool stalled() const { return mode_ == Mode::kStalled; }
  uint64_t stalls() const { return stalls_; }
  /// release() was called, and zero was sent since.
  bool released() const { return mode_ == Mode::kReleased && silent_; }

 private:
  enum class Mode { kResting, kLive, kStalled, kReleased };
  static Time after(Time time, double span_s);
  bool late(Time now) const;
  void noticeStall(Time now);
  ForceLimits limitsNow(const ForceLimits& usual) const;

  std::vector<ForceLimiter> limiters_;  ///< [styluses]
  double stall_s_;
  Mode mode_ = Mode::kResting;
  Wrenches wanted_;
  Time last_put_{}, last_next_{};
  bool reached_ = true;  ///< what was sent last is what is wanted
  bool silent_ = false;  ///< what was sent last is zero for all
  int in_time_ = 0;      ///< ticks since a stall
  uint64_t stalls_ = 0;
};

}  // namespace viscera::nodes
