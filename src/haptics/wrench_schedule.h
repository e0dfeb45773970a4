// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/math/types.h"
#include "viscera/tools/force_limiter.h"

namespace viscera {

using Wrenches = std::array<Reaction, layout::kMaxStyluses>;
/// Which hands are there and feel something; the others are let go of.
using HandsThere = std::array<bool, layout::kMaxStyluses>;

/// What devices are told, and when: the simulation's answers, limited in size and slew in wall-clock time; nothing
/// where they are late, rest or have ended. Knows neither ROS nor threads; times are the caller's, and never go back.
class WrenchSchedule {
 public:
  using Time = SteadyTime;
  /// How a force goes away in an ordered end or a stall, however slow the slew that its device is used to [s].
  static constexpr double kRelease_s = 0.01;
  /// The same where the tissue rests or a hand is not there, from what was sent last, whatever limits and slew say [s].
  static constexpr double kLetGo_s = 0.1;
  /// Between two messages while a limit holds a wrench back: fine enough that a device feels a ramp [s].
  static constexpr double kSlewPeriod_s = 0.002;
  /// Between two messages of zero while nothing else is to be said, for a device that comes late [s].
  static constexpr double kIdlePeriod_s = 0.02;
  /// Ticks in time, one after the other, that end a stall: a simulation that is always late gives no forces.
  static constexpr int kTicksInTime = 3;

  /// @param limits   [styluses]
  /// @param stall_s  a tick that comes later than this after the one before is a stall [s]
  WrenchSchedule(const std::vector<ForceLimits>& limits, double stall_s);

  /// Of a stylus, from the next() on: what is above them goes down by their slew.
  void setLimits(size_t stylus, const ForceLimits& limits);
  const ForceLimits& limits(size_t stylus) const { return limiters_[stylus].limits(); }
  /// A tick has come: ticks come in time, or do again.
  void tick(Time now);
  /// What is wanted from now on; heeded only while ticks come in time.
  void want(const Wrenches& wanted, const HandsThere& there, Time now);
  bool live() const { return mode_ == Mode::kLive; }
  /// There are no ticks, and no forces, until the next tick(): paused, or not begun.
  void rest(Time now);
  /// Zero for ever.
  void release(Time now);
  /// Zero, as soon as in an end, until resume(), whatever ticks say.
  void suspend(Time now);
  void resume(Time now);
  /// At the latest then next() is to be called, whatever has come.
  Time due() const;
  /// The wrenches to send now.
  Wrenches next(Time now);

  /// Less is sent than next() returned: slew goes on from there. @param force_n  no longer than it was
  void lessened(size_t stylus, const Vector3d& force_n) { limiters_[stylus].lessen(force_n); }

  bool stalled() const { return mode_ == Mode::kStalled; }
  uint64_t stalls() const { return stalls_; }
  /// release() was called, and zero was sent since.
  bool released() const { return mode_ == Mode::kReleased && silent_; }
  /// release() or suspend() was called, and zero was sent since.
  bool silenced() const { return closed() && silent_; }

 private:
  enum class Mode { kResting, kLive, kStalled, kSuspended, kReleased };
  /// A wrench that goes away evenly, at the latest within a time.
  struct LettingGo {
    bool on = true;
    Time since{};
    double within_s = kLetGo_s, force_n = 0, torque_nm = 0;  ///< what was sent last when it began
  };
  static Time after(Time time, double span_s);
  bool closed() const { return mode_ == Mode::kReleased || mode_ == Mode::kSuspended; }
  void close(Mode mode, Time now);
  bool late(Time now) const;
  void noticeStall(Time now);
  void letGo(size_t stylus, double within_s, Time now);
  void letAllGo(double within_s, Time now);
  ForceLimits limitsNow(const ForceLimits& usual) const;
  Reaction next(size_t stylus, double span_s, Time now);

  std::vector<ForceLimiter> limiters_;  ///< [styluses]
  std::vector<LettingGo> letting_go_;   ///< [styluses]
  double stall_s_;
  Mode mode_ = Mode::kResting;
  Wrenches wanted_;
  Time last_tick_{}, last_next_{};
  bool reached_ = true;  ///< what was sent last is what is wanted
  bool silent_ = false;  ///< what was sent last is zero for all
  int in_time_ = 0;      ///< ticks since a stall
  uint64_t stalls_ = 0;
};

}  // namespace viscera
