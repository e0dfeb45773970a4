// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace viscera::nodes {

/// Measures the durations of ticks.
class PaceMeter {
 public:
  struct Reading {
    double step_mean_s = 0, step_max_s = 0;  ///< wall-clock time of the work of a tick: mean and largest [s]
    double real_time_factor = 0;             ///< simulated over wall-clock time; 0 if there was no tick
  };

  /// Adds a tick. @param step_s  work of the tick [s]   @param wall_s  time since the previous tick [s]
  void add(double simulated_s, double step_s, double wall_s) {
    ++ticks_;
    simulated_s_ += simulated_s;
    step_s_ += step_s;
    wall_s_ += wall_s;
    longest_s_ = std::max(longest_s_, step_s);
  }
  /// Returns the measurements since the last call.
  Reading take() {
    Reading out;
    if (ticks_) out = {step_s_ / static_cast<double>(ticks_), longest_s_, wall_s_ > 0 ? simulated_s_ / wall_s_ : 0};
    *this = PaceMeter();
    return out;
  }

 private:
  uint64_t ticks_ = 0;
  double simulated_s_ = 0, step_s_ = 0, wall_s_ = 0, longest_s_ = 0;
};

}  // namespace viscera::nodes
