// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

namespace viscera::nodes {

/// Time that advances as fast as a simulation, from the times that it publishes. It stops while the simulation is
/// paused, never goes back, and does not jump at a reset.
class SimulatedTime {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// Sets the simulation's time. @param time_s  since its start or reset [s]   @param tick_s  duration of a tick [s]
  void tell(double time_s, double tick_s, SteadyTime now) {
    if (!last_ || time_s == last_s_) {
      if (!last_) advanced_ = now;
    } else {
      elapsed_s_ = time_s > last_s_ ? elapsed_s_ + time_s - last_s_ : at(now);
      advanced_ = now;
    }
    last_s_ = time_s;
    tick_s_ = tick_s;
    last_ = true;
  }
  /// Returns the time since the first call of tell() [s]. Within a tick it advances with the clock.
  double at(SteadyTime now) const {
    if (!last_) return 0;
    return elapsed_s_ + std::clamp(std::chrono::duration<double>(now - advanced_).count(), 0.0, tick_s_);
  }

 private:
  bool last_ = false;
  double last_s_ = 0, tick_s_ = 0, elapsed_s_ = 0;
  SteadyTime advanced_{};  ///< time at which the simulation last advanced
};

}  // namespace viscera::nodes
