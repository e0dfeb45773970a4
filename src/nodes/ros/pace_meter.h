// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace viscera::nodes {

/// Sums up how long ticks took, until asked.
class PaceMeter {
 public:
  struct Reading {
    double step_mean_s = 0, step_max_s = 0;  ///< wall-clock time of the work of a tick
    double real_time_factor = 0;             ///< simulated over wall-clock time; 0 where no tick was made
  };

  /// @param step_s  work of the tick [s]   @param wall_s  from the tick before to this one [s]
  void add(double simulated_s, double step_s, double wall_s) {
    ++ticks_;
    simulated_s_ += simulated_s;
    step_s_ += step_s;
    wall_s_ += wall_s;
    longest_s_ = std::max(longest_s_, step_s);
  }
  /// The ticks since the last reading.
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
