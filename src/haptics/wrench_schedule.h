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
/// Which styluses are tracked and subscribe to forces; the forces of others fade out.
using ListeningStyluses = std::array<bool, layout::kMaxStyluses>;

/// Decides what devices receive, and when: the simulation's forces, limited in size and slew rate in wall-clock time,
/// and zero while ticks are late, paused or have ended. It depends neither on ROS nor on threads. The caller supplies
/// times, which never go back.
class WrenchSchedule {
 public:
  using Time = SteadyTime;
  /// Time for a force to fade out at an orderly end or a stall, whatever the device's slew rate [s].
  static constexpr double kRelease_s = 0.01;
  /// Time for a force to fade out while paused or not tracked, from the last value that was sent, whatever limits and
  /// slew rate are [s].
  static constexpr double kLetGo_s = 0.1;
  /// Time between two messages while a limit applies: short enough that the user feels a ramp [s].
  static constexpr double kSlewPeriod_s = 0.002;
  /// Time between two messages of zero when there is nothing else to send, for a device that connects late [s].
  static constexpr double kIdlePeriod_s = 0.02;
  /// Number of successive ticks in time that end a stall: a simulation that is always late gives no forces.
  static constexpr int kTicksInTime = 3;

  /// @param limits   [styluses]
  /// @param stall_s  longest time between two ticks that is not a stall [s]
  WrenchSchedule(const std::vector<ForceLimits>& limits, double stall_s);

  /// Sets the limits of a stylus, effective with the following next(): larger forces decrease at their slew rate.
  void setLimits(size_t stylus, const ForceLimits& limits);
  const ForceLimits& limits(size_t stylus) const { return limiters_[stylus].limits(); }
  /// Records the arrival of a tick.
  void tick(Time now);
  /// Sets the desired wrenches; ignored unless ticks come in time.
  void request(const Wrenches& wanted, const ListeningStyluses& there, Time now);
  bool live() const { return mode_ == Mode::kLive; }
  /// Stops forces until the next tick(), because the simulation is paused or has not begun.
  void rest(Time now);
  /// Sends zero from now on.
  void release(Time now);
  /// Fades out as at an end, until resume(), regardless of ticks.
  void suspend(Time now);
  void resume(Time now);
  /// Returns the latest time for the next call of next().
  Time due() const;
  /// Returns the wrenches to send now.
  Wrenches next(Time now);

  /// Records that a smaller force was sent than next() returned; slew continues from there.
  /// @param force_n  not longer than it was
  void lessened(size_t stylus, const Vector3d& force_n) { limiters_[stylus].lessen(force_n); }

  bool stalled() const { return mode_ == Mode::kStalled; }
  uint64_t stalls() const { return stalls_; }
  /// Returns whether release() was called and zero was sent since.
  bool released() const { return mode_ == Mode::kReleased && silent_; }
  /// Returns whether release() or suspend() was called and zero was sent since.
  bool silenced() const { return closed() && silent_; }

 private:
  enum class Mode { kResting, kLive, kStalled, kSuspended, kReleased };
  /// A wrench that fades out linearly within a time.
  struct LettingGo {
    bool on = true;
    Time since{};
    double within_s = kLetGo_s, force_n = 0, torque_nm = 0;  ///< duration [s], and initial size of the wrench
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
  bool reached_ = true;  ///< whether the last message has the desired wrench
  bool silent_ = false;  ///< whether the last message was zero for all
  int in_time_ = 0;      ///< number of ticks since a stall
  uint64_t stalls_ = 0;
};

}  // namespace viscera
