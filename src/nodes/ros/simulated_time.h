// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

namespace viscera::nodes {

/// Time that goes on as fast as a simulation does, made of the times that it tells: it stands while the simulation is
/// paused, never goes back, and a reset is no jump.
class SimulatedTime {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// The simulation says how far it is. @param time_s  since its start or reset   @param tick_s  in a tick
  void tell(double time_s, double tick_s, SteadyTime now) {
    if (!told_ || time_s == last_s_) {
      if (!told_) advanced_ = now;
    } else {
      elapsed_s_ = time_s > last_s_ ? elapsed_s_ + time_s - last_s_ : at(now);
      advanced_ = now;
    }
    last_s_ = time_s;
    tick_s_ = tick_s;
    told_ = true;
  }
  /// Since the first call of tell() [s]. Within a tick it runs on with the clock.
  double at(SteadyTime now) const {
    if (!told_) return 0;
    return elapsed_s_ + std::clamp(std::chrono::duration<double>(now - advanced_).count(), 0.0, tick_s_);
  }

 private:
  bool told_ = false;
  double last_s_ = 0, tick_s_ = 0, elapsed_s_ = 0;
  SteadyTime advanced_{};  ///< when the simulation last went on
};

}  // namespace viscera::nodes
